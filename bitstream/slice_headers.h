// SPDX-License-Identifier: Apache-2.0
// The slices of a scene, and what the units of its base and its slices begin with. Spec 7.3 - 7.9.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/parameter_sets.h"
#include "bitstream/units.h"
#include "slf/types.h"

namespace slf {

/// One slice of the slices unit: a run of cells, and how many points they hold.
struct SliceEntry {
  std::uint32_t slice_num_cells_minus1 = 0;
  std::uint32_t slice_num_points_minus1 = 0;

  std::size_t cells() const { return std::size_t{slice_num_cells_minus1} + 1; }
  std::size_t points() const { return std::size_t{slice_num_points_minus1} + 1; }
};

/// Spec 7.3: all slices of the scene, in Morton order.
struct SliceTable {
  std::uint32_t slices_num_minus1 = 0;
  std::uint32_t slices_start = 0;  ///< of several: a SliceStart, by its number
  std::vector<SliceEntry> slices;
  std::uint64_t offset = 0;  ///< of the slices unit in the stream

  /// One slice has no other to start from.
  bool shared() const {
    return slices_num_minus1 > 0 && slices_start == static_cast<std::uint32_t>(SliceStart::kShared);
  }
  bool apart() const { return slices_start == static_cast<std::uint32_t>(SliceStart::kApart); }

  std::uint64_t num_points() const {
    std::uint64_t points = 0;
    for (const SliceEntry& slice : slices) points += slice.points();
    return points;
  }
  std::uint64_t num_cells() const {
    std::uint64_t cells = 0;
    for (const SliceEntry& slice : slices) cells += slice.cells();
    return cells;
  }
};

// Spec 7.3  slices_unit( )
template <class V, class Table>
void slice_table(V& v, Table& t, std::uint32_t base_levels) {
  v.ue("slices_num_minus1", t.slices_num_minus1, Range{0, base_levels > 0 ? kMaxSlices - 1 : 0});
  if (t.slices_num_minus1 > 0) v.ue("slices_start", t.slices_start, defined(0, 2));
  v.resize("slices_num_minus1", t.slices, std::uint64_t{t.slices_num_minus1} + 1);
  for (auto& slice : t.slices) {
    if (base_levels > 0)
      v.ue("slice_num_cells_minus1", slice.slice_num_cells_minus1, Range{0, kMaxCells - 1});
    v.ue("slice_num_points_minus1", slice.slice_num_points_minus1,
         Range{slice.slice_num_cells_minus1, kMaxSlicePoints - 1});
  }
}

/// Spec 7.4 - 7.6, 7.9: what stands before the payload of a unit of the base or of a slice.
struct SliceUnitHeader {
  static constexpr std::uint32_t kBase = ~0u;
  std::uint32_t slice_id = kBase;
  std::uint32_t range = 0;                   ///< geometry, coefficient and refinement units
  std::uint32_t group = 0;                   ///< coefficient and refinement units
  std::uint32_t layer = 0;                   ///< refinement units: 1 .. 3
  std::vector<std::uint32_t> cu_prediction;  ///< coefficient units: [levels of the range], or none
  std::uint32_t cu_matrix_bytes = 0;         ///< coefficient units of range 0, with transforms

  bool of_base() const { return slice_id == kBase; }
};

/// Does a unit of this type begin with ids?
constexpr bool has_ids(UnitType type) {
  return type == UnitType::kGeometry || type == UnitType::kNormals ||
         type == UnitType::kCoefficients || type == UnitType::kDigest ||
         type == UnitType::kRefinement;
}

/// Do units of this type hold values of a plane group?
constexpr bool has_values(UnitType type) {
  return type == UnitType::kCoefficients || type == UnitType::kRefinement;
}

/// Memory for the columns of a group, coded: 2^20 entries of less than 8 bytes each.
inline constexpr std::int64_t kMaxMatrixBytes = 1 << 23;

/// Layers of a group: the first and its refinements.
inline constexpr std::uint32_t kMostLayers = 4;

/// What ids are called in the units.
struct IdNames {
  const char* range = "level_range";
  const char* slice = "slice_id";
  const char* group = "plane_group";
  const char* layer = "refinement_layer";
};
/// Spec 7.7: and in the index.
inline constexpr IdNames kIndexIds{"index_level_range", "index_slice_id", "index_plane_group",
                                   "index_refinement_layer"};

// Spec 7.4 - 7.6, 7.9  unit_ids( ): in the unit, and in the index.
template <class V, class Header>
void unit_ids(V& v, Header& h, UnitType type, const SequenceParameterSet& set,
              const IdNames& names = {}) {
  std::uint32_t base_ranges = 0;
  if (type == UnitType::kGeometry) {
    v.ue(names.range, h.range, Range{0, set.sps_num_geometry_ranges_minus1});
    base_ranges = set.base_geometry_ranges();
  }
  if (has_values(type)) {
    v.ue(names.range, h.range, Range{0, set.sps_num_coefficient_ranges_minus1});
    base_ranges = set.base_coefficient_ranges();
  }
  if (h.range >= base_ranges) v.ue(names.slice, h.slice_id, Range{0, kMaxSlices - 1});
  if (has_values(type)) v.ue(names.group, h.group, Range{0, set.sps_num_groups_minus1});
  if (type == UnitType::kRefinement)
    v.ue(names.layer, h.layer, Range{1, std::int64_t{kMostLayers} - 1});
}

// Spec 7.4  geometry_unit( ), 7.5 normals_unit( ), 7.6 coefficient_unit( ), 7.9 digest_unit( )
template <class V, class Header>
void slice_unit_header(V& v, Header& h, UnitType type, const SequenceParameterSet& set) {
  unit_ids(v, h, type, set);
  if (type != UnitType::kCoefficients || !v.ok()) return;
  if (set.sps_prediction_flag) {
    v.resize("cu_prediction", h.cu_prediction,
             set.coefficient_end(h.range) - set.coefficient_begin(h.range));
    for (auto& mode : h.cu_prediction)
      v.u(set.predicted ? 3 : 2, "cu_prediction", mode, Range{0, set.predicted ? 7 : 3});
  }
  if (set.sps_transform_flag && h.range == 0 && !set.predicted)
    v.ue("cu_matrix_bytes", h.cu_matrix_bytes, Range{0, kMaxMatrixBytes});
}

/// @errors of parsing; kOutOfRange also where cells are too many.
Result<SliceTable> parse_slice_table(std::span<const std::uint8_t> payload,
                                     const SequenceParameterSet& set);
/// The payload. @errors kInvalidArgument: an element that a reader would refuse
Result<std::vector<std::uint8_t>, InputError> write_slice_table(const SliceTable& table,
                                                                const SequenceParameterSet& set);

}  // namespace slf
