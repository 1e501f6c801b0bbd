// SPDX-License-Identifier: Apache-2.0
// The values of the sequence header, and what follows from them. Spec 7.2.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace slf {

/// Spec 7.1.2: streams of this major version are read.
inline constexpr int kVersionMajor = 1, kVersionMinor = 3;

/// Profiles that allow one tool more than the main one.
inline constexpr std::uint32_t kDracoProfile = 1, kTextureProfile = 2;
/// sps_coefficient_coder; 0 is the vector coder, 1 the independent one.
inline constexpr std::uint32_t kTextureCoder = 2, kLayeredCoder = 3;

/// sps_feature[1], 8.12.6, [2], 7.13, and [3], 8.12.7. 0 has no meaning: a stream of 1.0 shows that
/// it is refused.
inline constexpr std::uint32_t kReferenceContexts = 1u << 30, kEmptyFrame = 1u << 29,
                               kMovedPoints = 1u << 28,
                               kKnownFeatures = kReferenceContexts | kEmptyFrame | kMovedPoints;

inline constexpr std::uint32_t kMaxSlicePoints = 1u << 22;
inline constexpr std::uint32_t kMaxSlices = 1u << 16;
inline constexpr std::uint32_t kMaxCells = 1u << 22;

/// sps_attribute_id. Spec 6.8. 0 is without a meaning; those after kShapeAttribute are not known.
inline constexpr std::uint32_t kOpacityAttribute = 1, kShapeAttribute = 2;

/// Functions k .. k + length - 1 share group, shift and steps.
struct PlaneRun {
  std::uint32_t sps_run_length_minus1 = 0;
  std::uint32_t sps_plane_group = 0;
  std::uint32_t sps_plane_shift = 0;
  std::uint32_t sps_equal_steps_flag = 1;
  std::array<std::uint32_t, 3> sps_plane_step{1, 1, 1};
};

/// Values of a point that are no view map. Spec 6.8
struct PointAttribute {
  std::uint32_t sps_attribute_id = 0;
  std::uint32_t sps_attribute_functions_minus1 = 0;
};
inline constexpr std::uint32_t kMaxAttributes = 16;

/// Spec 7.2. Defaults are what is inferred where an element is not present.
struct SequenceParameterSet {
  std::uint32_t sps_profile = 0, sps_level = 0;
  std::uint32_t sps_grid_bits_minus1 = 0;
  std::uint32_t sps_unit_grid_flag = 1;
  std::array<double, 3> sps_origin{0, 0, 0};
  double sps_step = 1;
  std::uint32_t sps_up_axis = 6, sps_left_handed_flag = 0, sps_metres_flag = 0;
  double sps_metres_per_unit = 0;
  std::uint32_t sps_geometry_coder = 0;
  std::uint32_t sps_normal_bits = 0;
  std::uint32_t sps_base_levels = 0;
  std::uint32_t sps_cut_flag = 0, sps_cut_levels = 0, sps_cut_groups = 0, sps_cut_slices_flag = 0;
  std::uint32_t sps_num_functions = 0;
  std::uint32_t sps_basis_flag = 0;
  std::uint32_t sps_basis_idc = 0, sps_order_minus1 = 1, sps_scales_theta = 0, sps_scales_gamma = 0;
  std::uint32_t sps_degree = 0;
  std::uint32_t sps_directions_idc = 0, sps_colour_idc = 0, sps_transfer_idc = 0;
  std::int32_t sps_gamma_min = -127, sps_gamma_max = 127;
  std::uint32_t sps_normal_cell_log2 = 0;
  std::uint32_t sps_num_attributes = 0;
  std::vector<PointAttribute> attributes;
  std::uint32_t sps_coefficient_coder = 0, sps_num_groups_minus1 = 0;
  std::uint32_t sps_prediction_flag = 0;
  std::vector<std::uint32_t> sps_num_layers_minus1;  ///< [groups] with kLayeredCoder
  std::uint32_t sps_cut_layers = 0;
  std::uint32_t sps_texture_bits = 0, sps_texture_cell_log2 = 0;
  std::vector<PlaneRun> runs;
  std::uint32_t sps_transform_flag = 0;
  std::uint32_t sps_num_transforms_minus1 = 0;
  std::uint32_t sps_num_geometry_ranges_minus1 = 0, sps_num_coefficient_ranges_minus1 = 0;
  std::vector<std::uint32_t> sps_geometry_range_end, sps_coefficient_range_end;
  std::uint32_t features = 0;  ///< sps_feature[i], bit 31 - i
  /// No element: frame_predicted_flag of the frame whose units these are. Spec 7.13
  bool predicted = false;

  /// The lowest minor version that has all of it. Spec 7.1.2
  int version_minor() const {
    return has_moved_points() ? 3 : is_empty_frame() ? 2 : features != 0 ? 1 : 0;
  }
  /// A frame without points, alone in its group of frames. Spec 7.13
  bool is_empty_frame() const { return (features & kEmptyFrame) != 0; }
  bool has_reference_contexts() const { return (features & kReferenceContexts) != 0; }
  /// May predicted frames move the points of their reference one by one? Spec 8.12.7
  bool has_moved_points() const { return (features & kMovedPoints) != 0; }
  std::uint32_t grid_bits() const { return sps_grid_bits_minus1 + 1; }
  bool has_draco() const { return sps_geometry_coder == 1; }
  bool has_texture() const { return sps_coefficient_coder == kTextureCoder; }
  /// Vectors, in one layer or several.
  bool has_vectors() const {
    return sps_coefficient_coder == 0 || sps_coefficient_coder == kLayeredCoder;
  }
  std::uint32_t layers_of(std::size_t group) const {
    return group < sps_num_layers_minus1.size() ? sps_num_layers_minus1[group] + 1 : 1;
  }
  /// As many as the group has that has most; 1 where there is none.
  std::uint32_t num_layers() const {
    std::uint32_t most = 1;
    for (std::size_t g = 0; g < sps_num_layers_minus1.size(); ++g)
      most = std::max(most, layers_of(g));
    return most;
  }
  int texture_bits() const { return 8 + 2 * static_cast<int>(sps_texture_bits); }
  std::uint32_t functions_of_basis() const {
    return sps_basis_idc == 0 ? 1u << (sps_scales_theta + sps_scales_gamma)
                              : (sps_degree + 1) * (sps_degree + 1);
  }
  std::uint32_t functions_of_attributes() const {
    std::uint32_t count = 0;
    for (const PointAttribute& a : attributes) count += a.sps_attribute_functions_minus1 + 1;
    return count;
  }
  std::uint32_t num_transforms() const {
    return sps_transform_flag ? sps_num_transforms_minus1 + 1 : 0;
  }
  std::uint32_t num_groups() const {
    return sps_num_functions == 0 ? 0 : sps_num_groups_minus1 + 1;
  }
  /// Level ranges. The last ends at grid_bits; a range begins where the one before ends.
  std::uint32_t geometry_end(std::uint32_t range) const {
    return range < sps_geometry_range_end.size() ? sps_geometry_range_end[range] : grid_bits();
  }
  std::uint32_t geometry_begin(std::uint32_t range) const {
    return range == 0 ? 0 : geometry_end(range - 1);
  }
  std::uint32_t coefficient_end(std::uint32_t range) const {
    return range < sps_coefficient_range_end.size() ? sps_coefficient_range_end[range]
                                                    : grid_bits();
  }
  std::uint32_t coefficient_begin(std::uint32_t range) const {
    return range == 0 ? 0 : coefficient_end(range - 1);
  }
  std::uint32_t geometry_ranges() const { return sps_num_geometry_ranges_minus1 + 1; }
  std::uint32_t coefficient_ranges() const {
    return sps_num_functions == 0 ? 0 : sps_num_coefficient_ranges_minus1 + 1;
  }
  /// Base ranges are those above level B; their number is that of the first range of slices.
  std::uint32_t base_geometry_ranges() const {
    std::uint32_t r = 0;
    while (r < geometry_ranges() && geometry_end(r) <= sps_base_levels) ++r;
    return r;
  }
  std::uint32_t base_coefficient_ranges() const {
    std::uint32_t r = 0;
    while (r < coefficient_ranges() && coefficient_end(r) <= sps_base_levels) ++r;
    return r;
  }
  /// Groups whose units are all there, where a cut leaves out the others.
  std::uint32_t kept_groups() const { return sps_cut_groups > 0 ? sps_cut_groups : num_groups(); }
  std::uint32_t kept_layers() const { return sps_cut_layers > 0 ? sps_cut_layers : num_layers(); }
};

}  // namespace slf
