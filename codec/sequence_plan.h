// What a decode needs to know of the sequence, and of what was asked for. Spec 8.2, 8.9.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "attributes/coefficient_decoder.h"
#include "attributes/plane_transform.h"
#include "bitstream/slice_headers.h"
#include "codec/decode_watch.h"
#include "slf/decoder.h"
#include "slf/types.h"

namespace slf {

struct SequencePlan {
  SequenceParameterSet set;
  SliceTable table;
  PlaneGroups groups;                ///< those to decode: places of their components
  std::vector<std::uint16_t> coded;  ///< [R] functions that components stand in
  std::vector<PlaneTransform> transforms;
  std::vector<std::uint32_t> steps;  ///< [3 R]
  int levels = 0;                    ///< octree levels to keep, 1 .. grid_bits
  int layers = 1;                    ///< of coefficients to decode, at most
  bool whole = true;     ///< no levels, groups or layers are left out: digests are checked
  bool missing = false;  ///< some are that would be part of what was asked for
  std::optional<VoxelBox> region;                ///< of the whole grid
  std::uint64_t stream_bytes = 0;                ///< of signature and units
  bool complete = false;                         ///< no unit is missing
  std::shared_ptr<DecodeWatch> watch = nullptr;  ///< where the caller wants to know

  int grid_bits() const { return static_cast<int>(set.grid_bits()); }
  int base_levels() const { return static_cast<int>(set.sps_base_levels); }
  bool has_base() const { return base_levels() > 0; }
  /// What was asked for is in the base alone: no unit of a slice is opened.
  bool base_alone() const { return levels <= base_levels(); }
  bool kept_levels_only() const { return levels < grid_bits(); }
  int dropped_levels() const { return grid_bits() - levels; }
  std::size_t planes() const { return 3 * coded.size(); }
  /// Weights, and normals, need all points, whatever levels are kept.
  bool needs_points() const {
    return !kept_levels_only() || planes() > 0 || (set.sps_normal_bits > 0 && !base_alone());
  }
  /// All levels of a coefficient unit are below those kept: it is not even opened.
  bool begins_below(std::uint32_t coefficient_range) const {
    return set.coefficient_begin(coefficient_range) >= static_cast<std::uint32_t>(levels);
  }
  /// Is this a unit of values that were asked for?
  bool wants_values(UnitType type, const SliceUnitHeader& unit) const {
    return has_values(type) && unit.group < groups.size() && !begins_below(unit.range) &&
           unit.layer < static_cast<std::uint32_t>(layers);
  }
  /// Bit of a Morton code of the grid that is the lowest of those that join nodes of a level.
  int lowest_split(int level) const { return 3 * (grid_bits() - level); }
  /// A unit of so many bytes is about to be decoded.
  Result<Done> begin_unit(std::uint64_t bytes) const {
    return watch ? watch->begin_unit(bytes) : Result<Done>(Done{});
  }
  /// Does a voxel of the kept levels stand for one in the region?
  bool in_region(const Voxel& voxel) const { return meets_region(voxel, levels); }
  /// Does the cube of a node at `level` meet the region?
  bool meets_region(const Voxel& node, int level) const;
};

/// @errors kInvalidArgument: levels or groups beyond what the stream has; those of the transforms.
Result<SequencePlan> plan_sequence(const Units& units, const SequenceParameterSet& set,
                                   const SliceTable& table, const DecodeOptions& options);

/// The header of what comes out, without points.
LightField empty_field(const SequencePlan& plan);

}  // namespace slf
