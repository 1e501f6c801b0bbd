// One slice, from its units to integers. Spec 8.2.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "attributes/coefficient_decoder.h"
#include "attributes/plane_transform.h"
#include "attributes/raht_tree.h"
#include "bitstream/parameter_sets.h"
#include "bitstream/units.h"
#include "slf/types.h"

namespace slf {

/// A unit of a slice with its header read.
struct SliceUnit {
  UnitType type{};
  SliceUnitHeader header;
  std::span<const std::uint8_t> payload;  ///< what follows the header
  std::uint64_t offset = 0;               ///< of the unit in the stream
};

/// What a decode needs to know of the sequence.
struct SequencePlan {
  SequenceParameterSet set;
  PlaneGroups groups;                ///< those to decode: places of their components
  std::vector<std::uint16_t> coded;  ///< [R] functions that components stand in
  std::vector<PlaneTransform> transforms;
  std::vector<std::uint32_t> steps;  ///< [3 R]
  int levels = 0;                    ///< octree levels to keep, 1 .. grid_bits
  bool whole = true;                 ///< no levels or groups are left out: digests are checked

  std::size_t planes() const { return 3 * coded.size(); }
  /// Weights, and normals, need all points, whatever levels are kept.
  bool needs_points() const {
    return !kept_levels_only() || planes() > 0 || set.sps_normal_bits > 0;
  }
  bool kept_levels_only() const { return levels < static_cast<int>(set.grid_bits()); }
};

/// A slice on its way. Steps are called in the order of the members below.
struct SliceDecoder {
  SliceHeader header;
  std::vector<SliceUnit> units;  ///< in stream order

  /// Occupancy to `positions` (on the grid of plan.levels bits) and the transform tree.
  Result<Done> decode_geometry(const SequencePlan& plan);
  /// Coefficients to components [positions][3 R]; the span is zero on entry.
  Result<Done> decode_components(const SequencePlan& plan, std::span<std::int32_t> components,
                                 int threads);
  Result<Done> decode_normals(const SequencePlan& plan,
                              std::span<std::array<std::uint16_t, 2>> normals);
  Result<Done> check_digest(std::span<const std::int32_t> components,
                            std::span<const std::array<std::uint16_t, 2>> normals) const;

  /// Leaves nothing of the slice's points.
  void drop() {
    positions = {};
    tree_ = {};
    codes_ = {};
    first_ = {};
  }

  std::vector<Voxel> positions;
  bool partial = false;  ///< units were missing

 private:
  Result<std::vector<std::uint64_t>> decode_octree(const SequencePlan& plan, int& depth);
  Result<std::vector<std::uint64_t>> decode_draco_unit();
  /// Spec 8.11. In slice_texture_decoder.cpp.
  Result<Done> decode_texture_units(const SequencePlan& plan, std::span<std::int32_t> components,
                                    int threads);
  using GroupModes = std::vector<std::vector<std::uint8_t>>;  // [groups][levels] cu_prediction
  void set_modes(const SliceUnitHeader& unit, std::uint32_t end_level, std::uint32_t grid_bits,
                 std::vector<std::uint8_t>& modes) const;
  Result<Done> reconstruct(const SequencePlan& plan, const GroupModes& modes, std::size_t used,
                           const CoefficientRows& rows, int threads) const;
  void keep(std::vector<std::uint64_t> morton, int depth, const SequencePlan& plan);

  std::vector<std::uint64_t> codes_;  // Morton codes within the slice of all points; empty where
                                      // the geometry is incomplete
  RahtTree tree_;                     // of the kept rows; empty where the geometry is incomplete
  std::vector<std::uint32_t> first_;  // [kept + 1] first point below each kept row
};

/// Octree level of the slice at which a level range of the sequence ends. 0 .. slice_depth.
int slice_level(std::uint32_t range_end, std::uint32_t grid_bits, std::uint32_t slice_depth);

/// End of level range `range`, in levels of the grid.
std::uint32_t range_end(const std::vector<std::uint32_t>& coded_ends, std::uint32_t range,
                        std::uint32_t grid_bits);

}  // namespace slf
