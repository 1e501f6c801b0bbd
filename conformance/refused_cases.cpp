// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>

#include "bitstream/parameter_sets.h"
#include "bitstream/unchecked_headers.h"
#include "codec/scene_units.h"
#include "conformance/cases.h"
#include "conformance/edit_units.h"
#include "conformance/fields.h"

namespace slf::conformance {
namespace {

/// The sequence header changed.
Bytes with_sequence(const std::function<void(SequenceParameterSet&)>& edit) {
  return edited([&](UnitList& units) {
    auto set = *parse_sequence_parameter_set(units[0].payload);
    edit(set);
    units[0].payload = sequence_as_is(set);
  });
}

void add_signature_and_framing(std::vector<RefusedCase>& cases) {
  Bytes stream = base_stream(true);
  stream[0] = 0x89;
  cases.push_back({"signature", "another first byte", {"7.1"}, stream});
  stream = base_stream(true);
  stream.resize(stream.size() / 2);
  cases.push_back({"truncated-in-unit", "ends inside a unit", {"7.1"}, stream});
  stream = base_stream(true);
  stream[stream.size() / 2] = static_cast<std::uint8_t>(stream[stream.size() / 2] ^ 4);
  cases.push_back({"crc", "one bit flipped", {"7.1"}, stream});
  stream = base_stream(true);
  stream.push_back(0);
  cases.push_back({"bytes-after-end", "one byte follows the end unit", {"7.1"}, stream});
  cases.push_back({"length-not-shortest", "a unit length with a needless byte", {"7.1"}, [] {
                     Bytes s(kSignature.begin(), kSignature.end());
                     for (const int byte : {99, 0x80, 0x00, 0, 0, 0, 0})
                       s.push_back(static_cast<std::uint8_t>(byte));
                     return s;
                   }()});
  cases.push_back({"no-sequence", "begins with a slice unit", {"7.1"}, edited([](auto& units) {
                     units.erase(units.begin());
                   })});
  cases.push_back(
      {"two-sequences", "the sequence unit is repeated", {"7.1"}, edited([](auto& units) {
         units.insert(units.begin() + 1, units[0]);
       })});
  cases.push_back(
      {"units-lost", "a digest fewer than the end unit counts units", {"7.10"}, [] {
         const Bytes whole = base_stream(false);
         const Units units = *split_units(whole);
         const Unit& lost = units.units[units.units.size() - 2];
         Bytes s(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(lost.offset));
         s.insert(s.end(), whole.begin() + static_cast<std::ptrdiff_t>(lost.offset + lost.bytes),
                  whole.end());
         return s;
       }()});
}

void add_sequence_headers(std::vector<RefusedCase>& cases) {
  const auto add = [&](const char* id, const char* purpose,
                       const std::function<void(SequenceParameterSet&)>& edit) {
    cases.push_back({id, purpose, {"7.2"}, with_sequence(edit)});
  };
  add("profile", "an unknown profile", [](auto& s) { s.sps_profile = 9; });
  add("level", "an unknown level", [](auto& s) { s.sps_level = 3; });
  add("grid-bits", "more than 21 bits", [](auto& s) { s.sps_grid_bits_minus1 = 25; });
  add("step-zero", "a grid step of 0", [](auto& s) { s.sps_unit_grid_flag = 0, s.sps_step = 0; });
  add("origin-nan", "a grid origin that is no number",
      [](auto& s) { s.sps_unit_grid_flag = 0, s.sps_origin[1] = std::nan(""); });
  add("up-axis", "up axis 7", [](auto& s) { s.sps_up_axis = 7; });
  add("normal-bits", "normals of 2 bits", [](auto& s) { s.sps_normal_bits = 2; });
  add("basis-idc", "an unknown basis", [](auto& s) { s.sps_basis_idc = 5; });
  add("functions-do-not-match", "scales that give another number of functions",
      [](auto& s) { s.sps_scales_theta = 2; });
  add("degree", "harmonics of a degree above 10",
      [](auto& s) { s.sps_basis_idc = 1, s.sps_degree = 11; });
  add("degree-does-not-match", "a degree that gives another number of functions",
      [](auto& s) { s.sps_basis_idc = 1, s.sps_degree = 2; });
  add("frame-idc", "unknown directions", [](auto& s) { s.sps_directions_idc = 2; });
  add("normal-cell", "normals of cells as large as the grid", [](auto& s) {
    s.sps_directions_idc = 1, s.sps_normal_cell_log2 = s.sps_grid_bits_minus1 + 1;
  });
  add("colour-idc", "an unknown colour transform", [](auto& s) { s.sps_colour_idc = 6; });
  add("gamma-range", "a gamma range that descends",
      [](auto& s) { s.sps_gamma_min = 10, s.sps_gamma_max = -10; });
  add("group-empty", "a group without a function", [](auto& s) { ++s.sps_num_groups_minus1; });
  add("base-levels", "a base of all levels",
      [](auto& s) { s.sps_base_levels = s.sps_grid_bits_minus1 + 1; });
  add("base-levels-of-no-geometry-range", "a base that ends within a geometry range",
      [](auto& s) { s.sps_geometry_range_end[1] = s.sps_base_levels + 1; });
  add("base-levels-of-no-coefficient-range", "a base that ends within a coefficient range",
      [](auto& s) { s.sps_coefficient_range_end[0] = s.sps_base_levels + 1; });
  add("base-of-draco", "a base in the Draco profile",
      [](auto& s) { s.sps_profile = kDracoProfile, s.sps_geometry_coder = 1; });
  add("cut-levels-zero", "a cut to no levels",
      [](auto& s) { s.sps_cut_flag = 1, s.sps_cut_levels = 0; });
  add("cut-groups-more", "a cut to more groups than there are",
      [](auto& s) { s.sps_cut_flag = s.sps_cut_levels = 1, s.sps_cut_groups = 3; });
  add("cut-with-digest", "a cut that left digests",
      [](auto& s) { s.sps_cut_flag = 1, s.sps_cut_levels = s.grid_bits(); });
  add("range-ends", "level ranges that do not ascend", [](auto& s) {
    s.sps_num_coefficient_ranges_minus1 = 2;
    s.sps_coefficient_range_end = {2, 2};
  });
  add("run-too-long", "a plane run beyond the last function",
      [](auto& s) { s.runs[0].sps_run_length_minus1 = 20; });
  add("draco-ranges", "level ranges of Draco's geometry", [](auto& s) {
    s.sps_profile = kDracoProfile, s.sps_geometry_coder = 1, s.sps_base_levels = 0;
  });
  cases.push_back({"header-shorter",
                   "a sequence header without its last byte",
                   {"3.3"},
                   edited([](auto& units) { units[0].payload.pop_back(); })});
}

void add_attributes(std::vector<RefusedCase>& cases) {
  const auto add = [&](const char* id, const char* purpose, std::vector<PointAttribute> attributes,
                       std::uint32_t less) {
    cases.push_back({id, purpose, {"6.8", "7.2"}, with_sequence([&](auto& s) {
                       s.sps_num_attributes = static_cast<std::uint32_t>(attributes.size());
                       s.attributes = attributes;
                       s.sps_basis_idc = 0;
                       s.sps_scales_theta = less;
                       s.sps_scales_gamma = 0;
                     })});
  };
  add("attribute-id", "an attribute of a later version", {{3, 2}}, 0);
  add("attribute-twice", "two opacities", {{1, 0}, {1, 0}}, 1);
  add("attribute-functions", "a shape of three functions", {{2, 2}}, 0);
  add("attributes-do-not-match", "more functions than those of basis and attributes", {{1, 0}}, 1);
  add("attributes-too-many", "17 attributes", std::vector<PointAttribute>(17, {0, 0}), 0);
}

}  // namespace

std::vector<RefusedCase> refused_cases() {
  std::vector<RefusedCase> cases;
  add_signature_and_framing(cases);
  add_sequence_headers(cases);
  add_attributes(cases);
  for (RefusedCase& scene : refused_scenes()) cases.push_back(std::move(scene));
  for (RefusedCase& unit : refused_units()) cases.push_back(std::move(unit));
  for (RefusedCase& growth : refused_growth()) cases.push_back(std::move(growth));
  for (RefusedCase& level : refused_levels()) cases.push_back(std::move(level));
  for (RefusedCase& layers : refused_layers()) cases.push_back(std::move(layers));
  for (RefusedCase& apart : refused_apart()) cases.push_back(std::move(apart));
  for (RefusedCase& texture : refused_textures()) cases.push_back(std::move(texture));
  for (RefusedCase& frame : refused_first_frames()) cases.push_back(std::move(frame));
  for (RefusedCase& alone : refused_alone()) cases.push_back(std::move(alone));
  for (RefusedCase& frame : refused_empty_frames()) cases.push_back(std::move(frame));
  for (RefusedCase& transform : refused_transforms()) cases.push_back(std::move(transform));
  return cases;
}

}  // namespace slf::conformance
