// SPDX-License-Identifier: Apache-2.0
// The sequence header, written once: visited to parse, to check and to write. Spec 7.2.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/level.h"
#include "bitstream/sequence_parameter_set.h"
#include "bitstream/syntax.h"
#include "slf/error.h"

namespace slf {

template <class V, class Run>
void plane_run(V& v, Run& r, std::uint32_t functions_left, std::uint32_t num_groups) {
  v.ue("sps_run_length_minus1", r.sps_run_length_minus1,
       Range{0, std::int64_t{functions_left} - 1});
  v.ue("sps_plane_group", r.sps_plane_group, Range{0, std::int64_t{num_groups} - 1});
  v.u(4, "sps_plane_shift", r.sps_plane_shift, Range{0, 15});
  v.u(1, "sps_equal_steps_flag", r.sps_equal_steps_flag, Range{0, 1});
  for (std::size_t c = 0; c < (r.sps_equal_steps_flag ? 1u : 3u); ++c)
    v.ue("sps_plane_step", r.sps_plane_step[c], Range{1, (1 << 27) - 1});
}

/// Level ranges: ends ascending, the last is grid_bits and is not coded.
template <class V, class Count, class Ends>
void level_ranges(V& v, const char* count_name, const char* end_name, Count& count_minus1,
                  Ends& ends, std::uint32_t grid_bits) {
  v.ue(count_name, count_minus1, Range{0, std::int64_t{grid_bits} - 1});
  v.resize(end_name, ends, count_minus1);
  std::int64_t least = 1;
  for (auto& end : ends) {
    v.u(5, end_name, end, Range{least, std::int64_t{grid_bits} - 1});
    least = std::int64_t{end} + 1;
  }
}

// Spec 7.2  what of the stream is the scene's, and what of it was left out
template <class V, class Set>
void base_and_cut(V& v, Set& s) {
  v.u(5, "sps_base_levels", s.sps_base_levels, Range{0, s.sps_grid_bits_minus1});
  v.require(s.sps_base_levels == 0 || s.sps_profile == 0, Errc::kOutOfRange, "sps_base_levels");
  v.u(1, "sps_cut_flag", s.sps_cut_flag, Range{0, 1});
  if (!s.sps_cut_flag) return;
  v.u(5, "sps_cut_levels", s.sps_cut_levels, Range{1, std::int64_t{s.grid_bits()}});
  v.ue("sps_cut_groups", s.sps_cut_groups, Range{0, 16});
  v.u(1, "sps_cut_slices_flag", s.sps_cut_slices_flag, Range{0, 1});
}

/// Where there is a base, a range of either kind ends with it.
template <class V, class Ends>
void base_is_end(V& v, std::uint32_t base_levels, const Ends& ends) {
  const bool is_end =
      base_levels == 0 || std::find(ends.begin(), ends.end(), base_levels) != ends.end();
  v.require(is_end, Errc::kOutOfRange, "sps_base_levels");
}

/// Runs until sps_num_functions functions are described.
template <class V, class Set>
void plane_table(V& v, Set& s) {
  std::uint32_t described = 0;
  for (std::size_t i = 0; v.ok() && described < s.sps_num_functions; ++i) {
    if constexpr (requires { s.runs.emplace_back(); })
      if (i == s.runs.size()) s.runs.emplace_back();
    // Runs of a writer may be too short: those of functions that no run describes are not there.
    v.require(i < s.runs.size(), Errc::kOutOfRange, "sps_num_functions");
    if (i == s.runs.size()) return;
    plane_run(v, s.runs[i], s.sps_num_functions - described, s.num_groups());
    described += s.runs[i].sps_run_length_minus1 + 1;
  }
}

// Spec 7.2, 6.8  the values of a point behind those of its view map
template <class V, class Set>
void point_attributes(V& v, Set& s) {
  v.ue("sps_num_attributes", s.sps_num_attributes, Range{0, kMaxAttributes});
  v.resize("sps_num_attributes", s.attributes, s.sps_num_attributes);
  std::uint32_t seen = 0;  // by bit: those with a meaning are there once
  for (auto& a : s.attributes) {
    v.ue("sps_attribute_id", a.sps_attribute_id, defined(0, kShapeAttribute));
    if (!v.ok()) return;
    v.require((seen >> a.sps_attribute_id & 1) == 0, Errc::kOutOfRange, "sps_attribute_id");
    if (a.sps_attribute_id > 0) seen |= 1u << a.sps_attribute_id;
    v.ue("sps_attribute_functions_minus1", a.sps_attribute_functions_minus1,
         a.sps_attribute_id == 0 ? Range{0, 4095}
                                 : Range{a.sps_attribute_id - 1, a.sps_attribute_id - 1});
  }
}

// Spec 7.2  what functions are of, and how their sum is a colour
template <class V, class Set>
void basis(V& v, Set& s) {
  v.u(4, "sps_basis_idc", s.sps_basis_idc, defined(0, 1));
  if (s.sps_basis_idc == 0) {
    v.u(2, "sps_order_minus1", s.sps_order_minus1, Range{0, 3});
    v.u(3, "sps_scales_theta", s.sps_scales_theta, defined(0, 6));
    v.u(3, "sps_scales_gamma", s.sps_scales_gamma, defined(0, 6));
  } else {
    v.u(4, "sps_degree", s.sps_degree, defined(0, 10));
  }
  v.u(3, "sps_directions_idc", s.sps_directions_idc, defined(0, 1));
  v.u(3, "sps_colour_idc", s.sps_colour_idc, defined(0, 1));
  v.u(2, "sps_transfer_idc", s.sps_transfer_idc, defined(0, 1));
  v.s8("sps_gamma_min", s.sps_gamma_min, Range{-127, 127});
  v.s8("sps_gamma_max", s.sps_gamma_max, Range{s.sps_gamma_min, 127});
  if (s.sps_directions_idc == 1)
    v.u(5, "sps_normal_cell_log2", s.sps_normal_cell_log2, Range{0, s.sps_grid_bits_minus1});
  point_attributes(v, s);
  v.require(!v.ok() || s.sps_num_functions == s.functions_of_basis() + s.functions_of_attributes(),
            Errc::kOutOfRange, "sps_num_functions");
}

// Spec 7.2  how many layers every group has
template <class V, class Set>
void group_layers(V& v, Set& s) {
  v.resize("sps_num_groups_minus1", s.sps_num_layers_minus1, s.num_groups());
  for (auto& layers : s.sps_num_layers_minus1) v.u(2, "sps_num_layers_minus1", layers, Range{0, 3});
  if (s.sps_cut_flag)
    v.u(2, "sps_cut_layers", s.sps_cut_layers, Range{0, std::int64_t{s.num_layers()} - 1});
}

// Spec 7.2  sequence_parameter_set( ), up to its trailing bits
template <class V, class Set>
void sequence_parameter_set(V& v, Set& s) {
  v.u(4, "sps_profile", s.sps_profile, defined(0, kTextureProfile));
  v.u(4, "sps_level", s.sps_level, defined(0, std::int64_t{kLevels.size() - 1}));
  v.u(5, "sps_grid_bits_minus1", s.sps_grid_bits_minus1, defined(0, 20));
  v.u(1, "sps_unit_grid_flag", s.sps_unit_grid_flag, Range{0, 1});
  if (!s.sps_unit_grid_flag) {
    for (auto& coordinate : s.sps_origin) v.f64("sps_origin", coordinate, false);
    v.f64("sps_step", s.sps_step, true);
  }
  v.u(3, "sps_up_axis", s.sps_up_axis, defined(0, 6));
  v.u(1, "sps_left_handed_flag", s.sps_left_handed_flag, Range{0, 1});
  v.u(1, "sps_metres_flag", s.sps_metres_flag, Range{0, 1});
  if (s.sps_metres_flag) v.f64("sps_metres_per_unit", s.sps_metres_per_unit, true);
  v.u(2, "sps_geometry_coder", s.sps_geometry_coder, defined(0, 1));
  v.require(s.has_draco() == (s.sps_profile == kDracoProfile), Errc::kOutOfRange,
            "sps_geometry_coder");
  v.u(4, "sps_normal_bits", s.sps_normal_bits, defined(0, 12));
  v.require(s.sps_normal_bits == 0 || s.sps_normal_bits >= 4, Errc::kUnsupported,
            "sps_normal_bits");
  base_and_cut(v, s);
  level_ranges(v, "sps_num_geometry_ranges_minus1", "sps_geometry_range_end",
               s.sps_num_geometry_ranges_minus1, s.sps_geometry_range_end, s.grid_bits());
  base_is_end(v, s.sps_base_levels, s.sps_geometry_range_end);
  v.require(!s.has_draco() || s.sps_num_geometry_ranges_minus1 == 0, Errc::kOutOfRange,
            "sps_num_geometry_ranges_minus1");
  v.ue("sps_num_functions", s.sps_num_functions, Range{0, 4096});
  if (s.sps_num_functions == 0) return;
  v.u(1, "sps_basis_flag", s.sps_basis_flag, Range{0, 1});
  if (s.sps_basis_flag) basis(v, s);
  v.u(2, "sps_coefficient_coder", s.sps_coefficient_coder, Range{0, kLayeredCoder});
  v.require(s.has_texture() == (s.sps_profile == kTextureProfile), Errc::kOutOfRange,
            "sps_coefficient_coder");
  if (!s.has_texture()) v.u(1, "sps_prediction_flag", s.sps_prediction_flag, Range{0, 1});
  if (s.has_texture()) {
    v.u(2, "sps_texture_bits", s.sps_texture_bits, defined(0, 2));
    v.u(3, "sps_texture_cell_log2", s.sps_texture_cell_log2, Range{0, 7});
  }
  v.u(4, "sps_num_groups_minus1", s.sps_num_groups_minus1, Range{0, 15});
  if (s.sps_coefficient_coder == kLayeredCoder) group_layers(v, s);
  v.u(1, "sps_transform_flag", s.sps_transform_flag, Range{0, s.has_texture() ? 0 : 1});
  if (s.sps_transform_flag)
    v.u(4, "sps_num_transforms_minus1", s.sps_num_transforms_minus1,
        Range{0, s.sps_num_groups_minus1});
  level_ranges(v, "sps_num_coefficient_ranges_minus1", "sps_coefficient_range_end",
               s.sps_num_coefficient_ranges_minus1, s.sps_coefficient_range_end, s.grid_bits());
  base_is_end(v, s.sps_base_levels, s.sps_coefficient_range_end);
  v.require(!s.has_texture() || s.sps_num_coefficient_ranges_minus1 == 0, Errc::kOutOfRange,
            "sps_num_coefficient_ranges_minus1");
  plane_table(v, s);
}

/// Spec 7.2.1  sps_feature[ ]: what a later version may have put behind the trailing bits. Features
/// are to be understood; what follows them is left to that version.
void later_elements(ParseSyntax& parse, SequenceParameterSet& set);

/// The version is that of this decoder: it stands before the payload (Unit).
Result<SequenceParameterSet> parse_sequence_parameter_set(std::span<const std::uint8_t> payload);
/// @errors kInvalidArgument: an element that a reader would refuse
Result<Done, InputError> check_sequence_parameter_set(const SequenceParameterSet& set);
/// The payload. @errors those of check_sequence_parameter_set
Result<std::vector<std::uint8_t>, InputError> write_sequence_parameter_set(
    const SequenceParameterSet& set);
}  // namespace slf
