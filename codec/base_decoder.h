// The base of a scene: its cells and their components, from which all slices go on. Spec 8.2.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/index.h"
#include "codec/component_decoder.h"
#include "codec/scene_units.h"
#include "codec/sequence_plan.h"
#include "geometry/occupancy_states.h"

namespace slf {

struct Base {
  std::vector<std::uint64_t> cells;  ///< Morton codes of the nodes at `level`
  int level = 0;                     ///< that is known; sps_base_levels where nothing is missing
  OccupancyStates states;            ///< of the last geometry unit, until a slice takes them
  std::vector<std::uint32_t> weight_before;  ///< [cells + 1], of those before each; with functions
  BaseComponents components;
  std::vector<std::uint32_t> first;  ///< [slices] first cell
  bool whole = true;                 ///< all units that were asked for are there

  std::span<const std::uint64_t> cells_of(const SliceTable& table, std::size_t slice) const {
    return std::span(cells).subspan(first[slice], table.slices[slice].cells());
  }
  CodeWeights weights() const { return CodeWeights(weight_before); }
  bool is_known(const SequencePlan& plan) const { return level == plan.base_levels(); }
};

/// 8.4: the cells and what they weigh. Without a base the root of the tree is the one cell.
/// @errors kOutOfRange also where they are not as many as the slices say.
Result<Base> decode_base_geometry(const PartUnits& units, const SequencePlan& plan);

/// Where boxes stand in the index, they are those of the slices. An error is of that unit.
Result<Done> check_boxes(const std::vector<CellBox>& boxes, const SequencePlan& plan,
                         const Base& base);

/// 8.6 - 8.8, for the slices to go on from, on one thread: their geometry, which needs all else of
/// the base, may be decoded beside it.
Result<Done> decode_base_components(const PartUnits& units, const SequencePlan& plan, Base& base);

/// What the base gives out by itself: all that was asked for, or all that there is. Spec 8.9.
Result<Done> give_out_base(const PartUnits& units, const SequencePlan& plan, int threads,
                           Base& base, LightField& field);

}  // namespace slf
