// SPDX-License-Identifier: Apache-2.0
// Table 8-1 as types: what a decoder keeps between units, a value for each lifetime.
//
//   of                      value                                     starts as
//   a codeword              RangeDecoder                              8.3.1
//   the columns of a group  contexts in code_columns()                new
//   a level                 history, in OctreeDecoder                 zero
//   the base, or a slice    nodes and octree state, in OctreeDecoder  start_octree()
//                           ValueState: states and kept vectors       start_values()
//   a slice                 NormalModel, and the normal before        new; 0
//   the scene               SceneState                                the base; then slice 0
//   a frame in time         FrameState (codec/frame_state.h)          the frame before
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "attributes/coefficient_models.h"
#include "attributes/raht_tree.h"
#include "attributes/slice_cells.h"
#include "codec/decoder/request.h"
#include "codec/states_of_slice0.h"
#include "geometry/occupancy_states.h"

namespace slf {

/// The rows whose components are decoded: nodes of the kept levels.
struct ComponentRows {
  std::span<const std::uint64_t> codes;  ///< of all points (base: cells), on the grid's axes
  const RahtTree& tree;
  std::span<const std::uint32_t> first;  ///< [rows + 1] first code of each
  int start = 0;                         ///< level where coding starts: 0, or that of the cells
  int levels = 0;                        ///< of the rows
  CodeWeights weights{};                 ///< of the codes
};

/// What units have told of the coefficients of rows: the inverse transform needs no more.
struct CodedCoefficients {
  SliceCells cells;                                ///< of a slice with a base; else empty
  std::vector<std::uint8_t> nonzero;               ///< [rows] a coefficient is not zero
  std::vector<std::uint8_t> any;                   ///< [groups] a value or coefficient is not zero
  std::vector<std::vector<std::uint8_t>> modes;    ///< [groups][levels from start] cu_prediction
  std::vector<std::vector<std::uint32_t>> layers;  ///< [groups][coefficient ranges] decoded so far
  const PartUnit* last = nullptr;                  ///< decoded, here or in the base
};

/// What the base, or a slice, keeps from coefficient unit to coefficient unit.
struct ValueState {
  CoefficientModels models;
  CodedCoefficients coded;
  std::vector<std::uint8_t> of_unit;  ///< [rows] as `nonzero`, in the unit decoded last
};

/// What slices start their values from.
struct BaseValues {
  std::optional<CoefficientModels> models;  ///< where no unit was decoded, none
  std::vector<CoefficientStates> states;    ///< [layers][groups]
  std::vector<std::int32_t> values;         ///< [cells][planes] mean * sqrt(its weight); the mean
                                            ///< where slices are apart
  std::vector<std::uint8_t> any;            ///< [groups] not all of its values are zero
  const PartUnit* last = nullptr;           ///< unit that was decoded last
};

/// What the base leaves. Without a base the root of the tree is the one cell.
struct BaseState {
  std::vector<std::uint64_t> cells;  ///< Morton codes of the nodes at `level`
  std::vector<std::uint32_t> first;  ///< [slices] first cell
  OccupancyStates octree;            ///< after the last geometry unit
  int level = 0;                     ///< that is known; sps_base_levels where nothing is missing
  std::vector<std::uint32_t> weight_before = {};  ///< [cells + 1], of those before; with functions
  BaseValues values = {};

  std::span<const std::uint64_t> cells_of(const SliceTable& table, std::size_t slice) const {
    return std::span(cells).subspan(first[slice], table.slices[slice].cells());
  }
  CodeWeights weights() const { return CodeWeights(weight_before); }
  bool is_known(const StreamHeader& stream) const { return level == stream.base_levels(); }
};

/// What the scene keeps. Slices read the base and, where they are shared, what slice 0 has left.
struct SceneState {
  explicit SceneState(const StreamHeader& stream, BaseState of_base)
      : base(std::move(of_base)), lead(stream.slots(Owner::kSlice).size()) {}

  BaseState base;
  StatesOfSlice0 lead;
};

/// A slice of a decode: what its steps read.
struct SliceToDecode {
  const Request& request;
  SceneState& scene;
  const PartUnits& units;
  std::size_t slice = 0;

  const StreamHeader& stream() const { return request.stream; }
  std::size_t points() const { return stream().table.slices[slice].points(); }
  std::span<const std::uint64_t> cells() const {
    return scene.base.cells_of(stream().table, slice);
  }
  bool leads() const { return stream().table.shared() && slice == 0; }
  bool follows() const { return stream().table.shared() && slice != 0; }
};

/// The octree state of a slice: new where slices are apart, else the base's. That of a slice which
/// follows slice 0 comes unit by unit.
/// @param alone  no other slice starts from the base: its state is moved
OccupancyStates start_octree(const SliceToDecode& slice, bool alone);

/// The base, or a slice without one, starts as new. Levels of missing units are predicted, what is
/// known is interpolated: spec 8.9.1.
ValueState start_values(const Request& request, const ComponentRows& rows);

/// A slice starts so: apart it knows its cells and is new; else it goes on from the base: states,
/// kept vectors, and values of the cells (8.6.4) in `components`, [rows][planes].
ValueState start_values(const SliceToDecode& slice, const ComponentRows& rows,
                        std::span<std::int32_t> components);

}  // namespace slf
