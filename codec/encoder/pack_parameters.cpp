// SPDX-License-Identifier: Apache-2.0
#include "codec/encoder/pack_parameters.h"

#include <algorithm>
#include <set>
#include <string>

#include "base/input_error.h"
#include "bitstream/metadata.h"
#include "codec/sequence.h"

namespace slf {
namespace {

/// There is one of everything for every point and function.
Result<Done, InputError> check_shapes(const LightField& field, const CodingParameters& p) {
  const LightFieldHeader& h = field.header;
  const std::size_t points = field.num_points(),
                    functions = static_cast<std::size_t>(h.num_functions);
  if (!h.attributes.empty() && !h.has_basis)
    return invalid_argument("attributes: of planes without a basis");
  if (!h.coded.empty() || !h.transforms.empty())
    return invalid_argument("components: of coded functions; given_planes() makes those of all");
  if (field.components.size() != points * functions * 3)
    return invalid_argument("components: not [points][functions][3]");
  if (!h.shift.empty() && h.shift.size() != functions)
    return invalid_argument("shift: one per function");
  if (field.normals.bits > 0 && field.normals.octahedral.size() != points)
    return invalid_argument("normals: one per point");
  if (!p.step.empty() && p.step.size() != functions)
    return invalid_argument("steps: three per function");
  if (!p.group.empty() && p.group.size() != functions)
    return invalid_argument("groups: one per function");
  if (!p.group.empty() && p.group[0] != 0 && h.attributes.empty())
    return invalid_argument("groups: function 0 is in group 0");
  const std::set<int> groups(p.group.begin(), p.group.end());
  const auto last = static_cast<int>(groups.size()) - 1;
  if (!groups.empty() && (*groups.begin() != 0 || *groups.rbegin() != last))
    return invalid_argument("groups: one is empty");
  if (!p.group_layers.empty() && p.group_layers.size() != std::max<std::size_t>(groups.size(), 1))
    return invalid_argument("quality layers: one number per group");
  return Done{};
}

/// Points are on the grid, normals have the bits that the header says.
Result<Done, InputError> check_points(const LightField& field) {
  const int bits = field.header.grid.bits, normal_bits = field.normals.bits;
  for (const Voxel& v : field.positions)
    for (const std::int32_t c : v)
      if (c < 0 || c >> bits != 0) return invalid_argument("positions: one lies outside the grid");
  for (const auto& n : field.normals.octahedral)
    if (normal_bits > 0 && (n[0] | n[1]) >> normal_bits != 0)
      return invalid_argument("normals: more bits than stated");
  return Done{};
}

int most_layers(const CodingParameters& p) {
  int most = p.quality_layers;
  for (const int layers : p.group_layers) most = std::max(most, layers);
  return most;
}

/// What no element of the sequence tells.
Result<Done, InputError> check_parameters(const LightField& field, const CodingParameters& p) {
  const LightFieldHeader& h = field.header;
  if (!(h.metres_per_unit >= 0)) return invalid_argument("metres per unit: 0 where not known");
  for (const auto* ends : {&p.geometry_level_ends, &p.coefficient_level_ends})
    if (!ends->empty() && ends->back() != h.grid.bits)
      return invalid_argument("level ends: ascending, the last the grid's bits");
  if (p.coefficients == CoefficientCoder::kTexture) {
    const int bits = p.texture.bits;
    if (bits != 8 && bits != 10 && bits != 12) return invalid_argument("texture bits: 8, 10 or 12");
    if (p.texture.qp < 0 || p.texture.qp > 51) return invalid_argument("texture qp: 0 to 51");
    if (p.transform != TransformMode::kNone)
      return invalid_argument("transform: a texture has none");
  }
  if (!(p.rdo >= 0 && p.rdo <= 1)) return invalid_argument("rdo: 0 to 1");
  int least = p.quality_layers;
  for (const int layers : p.group_layers) least = std::min(least, layers);
  if (least < 1) return invalid_argument("quality layers: 1 to 4");
  if (most_layers(p) > 1 && p.coefficients != CoefficientCoder::kVector)
    return invalid_argument("quality layers: of the vector coder alone");
  if (!is_metadata(p.metadata))
    return invalid_argument("metadata: keys without a name, zero bytes, not UTF-8, or over 1 MiB");
  static_assert(kMostSlicePoints == kMaxSlicePoints);
  if (p.max_slice_points < 1 || p.max_slice_points > kMaxSlicePoints)
    return invalid_argument("points per slice: 1 to 2^22");
  if (p.base_levels < kAutomaticBase)
    return invalid_argument("base levels: 0 to the grid's bits - 1");
  return Done{};
}

std::vector<PlaneRun> runs_of(const LightFieldHeader& header, const CodingParameters& p) {
  std::vector<PlaneRun> runs;
  for (std::size_t k = 0; k < static_cast<std::size_t>(header.num_functions); ++k) {
    PlaneRun run;
    run.sps_plane_group = p.group.empty() ? 0 : static_cast<std::uint32_t>(p.group[k]);
    run.sps_plane_shift = header.shift.empty() ? 0 : static_cast<std::uint32_t>(header.shift[k]);
    if (!p.step.empty()) run.sps_plane_step = p.step[k];
    const auto& s = run.sps_plane_step;
    run.sps_equal_steps_flag = s[0] == s[1] && s[1] == s[2];
    const bool same = !runs.empty() && runs.back().sps_plane_group == run.sps_plane_group &&
                      runs.back().sps_plane_shift == run.sps_plane_shift &&
                      runs.back().sps_plane_step == s;
    if (same) {
      ++runs.back().sps_run_length_minus1;
    } else {
      runs.push_back(run);
    }
  }
  return runs;
}

/// All but the last, which is inferred.
std::vector<std::uint32_t> coded_ends(const std::vector<int>& ends) {
  std::vector<std::uint32_t> coded;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    coded.push_back(static_cast<std::uint32_t>(ends[i]));
  return coded;
}

void add_end(std::uint32_t end, std::vector<std::uint32_t>& ends, std::uint32_t& num_minus1) {
  const auto place = std::lower_bound(ends.begin(), ends.end(), end);
  if (place == ends.end() || *place != end) ends.insert(place, end);
  num_minus1 = static_cast<std::uint32_t>(ends.size());
}

}  // namespace

void set_base(const SceneLayout& layout, SequenceParameterSet& set) {
  if (layout.base_levels == 0) return;
  set.sps_base_levels = static_cast<std::uint32_t>(layout.base_levels);
  add_end(set.sps_base_levels, set.sps_geometry_range_end, set.sps_num_geometry_ranges_minus1);
  if (set.sps_num_functions == 0) return;
  // Where levels are to be had one after the other, the first bytes have colours of all groups.
  const std::uint32_t coarser = set.sps_num_coefficient_ranges_minus1 > 0 ? 3 : 0;
  for (std::uint32_t up = 0; up <= std::min(coarser, set.sps_base_levels - 1); ++up)
    add_end(set.sps_base_levels - up, set.sps_coefficient_range_end,
            set.sps_num_coefficient_ranges_minus1);
}

Result<SequenceParameterSet, InputError> sequence_of(const LightField& field,
                                                     const CodingParameters& p) {
  if (field.num_points() == 0) return invalid_argument("positions: there are none");
  return sequence_of_frame(field, p);
}

Result<SequenceParameterSet, InputError> sequence_of_frame(const LightField& field,
                                                           const CodingParameters& p) {
  SLF_CHECK(check_shapes(field, p));
  return sequence_of_checked(field, p);
}

Result<SequenceParameterSet, InputError> sequence_of_checked(const LightField& field,
                                                             const CodingParameters& p) {
  SLF_CHECK(check_parameters(field, p));
  const LightFieldHeader& h = field.header;
  SequenceParameterSet set;
  const bool texture = p.coefficients == CoefficientCoder::kTexture && h.num_functions > 0;
  set.sps_geometry_coder = static_cast<std::uint32_t>(p.geometry);
  set.sps_profile = texture ? kTextureProfile : set.sps_geometry_coder;
  set.sps_grid_bits_minus1 = static_cast<std::uint32_t>(h.grid.bits - 1);
  set.sps_unit_grid_flag = h.grid.origin == Vec3{0, 0, 0} && h.grid.step == 1;
  set.sps_origin = h.grid.origin;
  set.sps_step = h.grid.step;
  set.sps_up_axis = static_cast<std::uint32_t>(h.up);
  set.sps_left_handed_flag = !h.right_handed;
  set.sps_metres_flag = h.metres_per_unit > 0;
  set.sps_metres_per_unit = h.metres_per_unit;
  set.sps_normal_bits = static_cast<std::uint32_t>(field.normals.bits);
  set.sps_geometry_range_end = coded_ends(p.geometry_level_ends);
  set.sps_num_geometry_ranges_minus1 =
      static_cast<std::uint32_t>(set.sps_geometry_range_end.size());
  set.sps_num_functions = static_cast<std::uint32_t>(h.num_functions);
  set.sps_basis_flag = h.has_basis && h.num_functions > 0;
  set.sps_basis_idc = static_cast<std::uint32_t>(h.basis.id);
  set.sps_degree = static_cast<std::uint32_t>(h.basis.degree);
  set.sps_order_minus1 = static_cast<std::uint32_t>(h.basis.order - 1);
  set.sps_scales_theta = static_cast<std::uint32_t>(h.basis.scales_theta);
  set.sps_scales_gamma = static_cast<std::uint32_t>(h.basis.scales_gamma);
  set.sps_directions_idc = static_cast<std::uint32_t>(h.directions);
  set.sps_colour_idc = static_cast<std::uint32_t>(h.colour);
  set.sps_transfer_idc = static_cast<std::uint32_t>(h.transfer);
  set.sps_gamma_min = h.gamma_min_q7;
  set.sps_gamma_max = h.gamma_max_q7;
  if (h.directions == Directions::kReflected)
    set.sps_normal_cell_log2 = static_cast<std::uint32_t>(h.normal_cell_log2);
  for (const Attribute& a : h.attributes)
    set.attributes.push_back(
        {static_cast<std::uint32_t>(a.id), static_cast<std::uint32_t>(a.num_functions - 1)});
  set.sps_num_attributes = static_cast<std::uint32_t>(set.attributes.size());
  if (h.num_functions > 0) set.sps_coefficient_coder = static_cast<std::uint32_t>(p.coefficients);
  set.sps_prediction_flag = p.predict && !texture && h.num_functions > 0;
  if (texture) set.sps_texture_bits = static_cast<std::uint32_t>(p.texture.bits - 8) / 2;
  set.runs = runs_of(h, p);
  for (const PlaneRun& run : set.runs)
    set.sps_num_groups_minus1 = std::max(set.sps_num_groups_minus1, run.sps_plane_group);
  if (h.num_functions > 0 && most_layers(p) > 1) {
    set.sps_coefficient_coder = kLayeredCoder;
    for (std::size_t g = 0; g < set.num_groups(); ++g)
      set.sps_num_layers_minus1.push_back(static_cast<std::uint32_t>(
          (p.group_layers.empty() ? p.quality_layers : p.group_layers[g]) - 1));
  }
  set.sps_coefficient_range_end = coded_ends(p.coefficient_level_ends);
  set.sps_num_coefficient_ranges_minus1 =
      static_cast<std::uint32_t>(set.sps_coefficient_range_end.size());
  SLF_CHECK(check_sequence_parameter_set(set));
  SLF_CHECK(check_points(field));
  return set;
}

std::vector<std::uint32_t> plane_steps(const SequenceParameterSet& set) {
  std::vector<std::uint32_t> steps;
  for (const auto& step : function_steps(set)) steps.insert(steps.end(), step.begin(), step.end());
  return steps;
}

}  // namespace slf
