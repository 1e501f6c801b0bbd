// SPDX-License-Identifier: Apache-2.0
// Sequence headers that together have every element.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bitstream/parameter_sets.h"

namespace slf::header_sets {

inline SequenceParameterSet full_set() {
  SequenceParameterSet s;
  s.sps_grid_bits_minus1 = 20;
  s.sps_unit_grid_flag = 0;
  s.sps_origin = {-1, 2.5, 1e300};
  s.sps_step = 1e-9;
  s.sps_up_axis = 3;
  s.sps_left_handed_flag = s.sps_metres_flag = 1;
  s.sps_metres_per_unit = 0.001;
  s.sps_normal_bits = 12;
  s.sps_num_geometry_ranges_minus1 = 2;
  s.sps_geometry_range_end = {5, 20};
  s.sps_num_functions = 128;
  s.sps_basis_flag = 1;
  s.sps_order_minus1 = 3;
  s.sps_scales_theta = 4;
  s.sps_scales_gamma = 3;
  s.sps_colour_idc = s.sps_transfer_idc = s.sps_coefficient_coder = 1;
  s.sps_gamma_min = -90;
  s.sps_gamma_max = 127;
  s.sps_directions_idc = 1;
  s.sps_normal_cell_log2 = s.sps_grid_bits_minus1;
  s.sps_num_groups_minus1 = 2;
  s.sps_num_coefficient_ranges_minus1 = 1;
  s.sps_coefficient_range_end = {19};
  s.runs = {
      {0, 0, 6, 1, {1, 1, 1}}, {99, 1, 15, 0, {1, 2, (1u << 27) - 1}}, {26, 2, 0, 1, {77, 1, 1}}};
  return s;
}

inline SequenceParameterSet texture_set() {
  SequenceParameterSet s = full_set();
  s.sps_profile = kTextureProfile;
  s.sps_coefficient_coder = kTextureCoder;
  s.sps_texture_bits = 2;
  s.sps_texture_cell_log2 = 7;
  s.sps_num_coefficient_ranges_minus1 = 0;
  s.sps_coefficient_range_end = {};
  return s;
}

inline SequenceParameterSet layered_set() {
  SequenceParameterSet s = full_set();
  s.sps_coefficient_coder = kLayeredCoder;
  s.sps_num_layers_minus1 = {3, 0, 2};
  s.sps_cut_flag = 1;
  s.sps_cut_levels = 21;
  s.sps_cut_layers = 3;
  return s;
}

inline SequenceParameterSet cut_set() {
  SequenceParameterSet s = full_set();
  s.sps_base_levels = 5;
  s.sps_coefficient_range_end = {5};
  s.sps_cut_flag = s.sps_cut_slices_flag = 1;
  s.sps_cut_levels = 21;
  s.sps_cut_groups = 3;
  return s;
}

/// Gaussians, harmonics and transforms.
inline SequenceParameterSet splat_set() {
  SequenceParameterSet s = full_set();
  s.sps_basis_idc = 1;
  s.sps_degree = 2;
  s.sps_num_functions = 12;
  s.sps_num_attributes = 2;
  s.attributes = {{1, 0}, {2, 1}};
  s.sps_num_groups_minus1 = 0;
  s.sps_transform_flag = 1;
  s.sps_num_transforms_minus1 = 0;
  s.runs = {{11, 0, 0, 1, {8, 8, 8}}};
  return s;
}

inline std::vector<std::pair<std::string, SequenceParameterSet>> all() {
  return {{"full", full_set()}, {"texture", texture_set()}, {"layered", layered_set()},
          {"cut", cut_set()},   {"splats", splat_set()},    {"geometry", {}}};
}

}  // namespace slf::header_sets
