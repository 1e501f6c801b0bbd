// SPDX-License-Identifier: Apache-2.0
#include "codec/sequence.h"

#include <algorithm>

namespace slf {
namespace {

/// Calls each(k, run) for every function.
template <class Each>
void for_each_function(const SequenceParameterSet& set, Each each) {
  std::size_t k = 0;
  for (const PlaneRun& run : set.runs)
    for (std::uint32_t i = 0; i <= run.sps_run_length_minus1; ++i) each(k++, run);
}

}  // namespace

LightFieldHeader header_of(const SequenceParameterSet& set) {
  LightFieldHeader header;
  header.grid = {set.sps_origin, set.sps_step, static_cast<int>(set.grid_bits())};
  header.up = static_cast<UpAxis>(set.sps_up_axis);
  header.right_handed = set.sps_left_handed_flag == 0;
  header.metres_per_unit = set.sps_metres_per_unit;
  header.num_functions = static_cast<int>(set.sps_num_functions);
  header.has_basis = set.sps_basis_flag != 0;
  header.basis = {static_cast<BasisId>(set.sps_basis_idc),
                  static_cast<int>(set.sps_order_minus1) + 1,
                  static_cast<int>(set.sps_scales_theta), static_cast<int>(set.sps_scales_gamma),
                  static_cast<int>(set.sps_degree)};
  header.directions = static_cast<Directions>(set.sps_directions_idc);
  header.colour = static_cast<ColourTransform>(set.sps_colour_idc);
  header.transfer = static_cast<Transfer>(set.sps_transfer_idc);
  header.gamma_min_q7 = set.sps_gamma_min;
  header.gamma_max_q7 = set.sps_gamma_max;
  header.normal_cell_log2 = static_cast<int>(set.sps_normal_cell_log2);
  for (const PointAttribute& a : set.attributes)
    header.attributes.push_back({static_cast<AttributeId>(a.sps_attribute_id),
                                 static_cast<int>(a.sps_attribute_functions_minus1) + 1});
  header.shift.resize(set.sps_num_functions);
  for_each_function(set, [&](std::size_t k, const PlaneRun& run) {
    header.shift[k] = static_cast<int>(run.sps_plane_shift);
  });
  return header;
}

std::vector<int> function_groups(const SequenceParameterSet& set) {
  std::vector<int> group(set.sps_num_functions);
  for_each_function(set, [&](std::size_t k, const PlaneRun& run) {
    group[k] = static_cast<int>(run.sps_plane_group);
  });
  return group;
}

std::vector<std::array<std::uint32_t, 3>> function_steps(const SequenceParameterSet& set) {
  std::vector<std::array<std::uint32_t, 3>> step(set.sps_num_functions);
  for_each_function(set, [&](std::size_t k, const PlaneRun& run) {
    const auto& s = run.sps_plane_step;
    step[k] = run.sps_equal_steps_flag ? std::array{s[0], s[0], s[0]} : s;
  });
  return step;
}

PlaneGroups plane_groups(const SequenceParameterSet& set) {
  PlaneGroups groups(set.num_groups());
  const auto group = function_groups(set);
  for (std::size_t k = 0; k < group.size(); ++k)
    groups[static_cast<std::size_t>(group[k])].push_back(static_cast<std::uint16_t>(k));
  return groups;
}

void make_coarser(LightFieldHeader& header, int levels) {
  Grid& grid = header.grid;
  const int left_out = grid.bits - levels;
  const std::int32_t cells = 1 << left_out;
  for (auto& coordinate : grid.origin) coordinate += grid.step * (cells - 1) / 2;
  grid.step *= cells;
  grid.bits = levels;
  header.levels_left_out += left_out;
  header.normal_cell_log2 = std::max(header.normal_cell_log2 - left_out, 0);
}

}  // namespace slf
