// SPDX-License-Identifier: Apache-2.0
// What ordinary files show and small ones do not: counts beyond thresholds, boxes with odd corners,
// parts of light fields with normals.
#include "bitstream/parameter_sets.h"
#include "conformance/cases.h"
#include "conformance/edit_units.h"
#include "conformance/fields.h"

namespace slf::conformance {
namespace {

/// Some 17 nodes a point, most of one child.
LightField far_apart(std::size_t points) { return field(scattered(points, 21, 41), 21, 0); }

void add_counts(std::vector<Case>& cases) {
  Case nodes = case_of("nodes-43000", "more than 40,960 nodes: the rate is the least", {"8.4.1"},
                       far_apart(2600));
  nodes.parameters.index = false;
  cases.push_back(nodes);
  Case shared =
      case_of("slices-of-9000-nodes", "slices that start with more than 8,192 nodes coded",
              {"8.1", "8.4.1"}, far_apart(1100));
  shared.parameters.base_levels = 1;
  shared.parameters.max_slice_points = 560;
  cases.push_back(shared);
}

/// Three groups, normals, a base of two levels and slices behind it.
Case ordinary_scene(const char* id, const char* purpose, std::vector<std::string> clauses) {
  Case c = case_of(id, purpose, std::move(clauses), field(small_sphere(), 5, 4), with_steps(4, 30));
  c.parameters.group = {0, 1, 1, 2};
  c.parameters.geometry_level_ends = {1, 2, 4, 5};
  c.parameters.coefficient_level_ends = {2, 4, 5};
  c.parameters.base_levels = 2;
  c.parameters.max_slice_points = 400;
  c.parameters.index = false;
  c.field.normals.bits = 7;
  for (std::size_t p = 0; p < c.field.num_points(); ++p)
    c.field.normals.octahedral.push_back(
        {static_cast<std::uint16_t>(p * 3 % 128), static_cast<std::uint16_t>(p / 7 % 128)});
  return c;
}

/// Boxes whose corners no cube of a coarser level has.
void add_corners(std::vector<Case>& cases) {
  Case odd = ordinary_scene("regions-odd-corners",
                            "boxes with odd corners, of all levels and of fewer", {"8.9.4"});
  odd.levels = {1, 2, 3, 4};
  odd.regions = {{{5, 3, 7}, {21, 13, 25}}, {{9, 11, 1}, {9, 29, 30}}};
  cases.push_back(odd);
  Case cut =
      ordinary_scene("regions-of-a-prefix", "the same of a stream that ends in its second slice",
                     {"8.9.2", "8.9.4"});
  cut.keep_units = 13;
  cut.levels = {1, 3};
  cut.groups = {1};
  cut.regions = {{{5, 3, 7}, {21, 13, 25}}};
  cases.push_back(cut);
}

/// Units: sequence, slices, 2 of the base's geometry and 3 of its coefficients; of a slice 2 of
/// geometry, normals, 6 of coefficients.
void add_ordinary_prefixes(std::vector<Case>& cases) {
  for (const std::size_t units : {3u, 9u, 10u}) {
    Case c = ordinary_scene(units == 3   ? "prefix-of-the-base-and-levels"
                            : units == 9 ? "prefix-of-normals-none"
                                         : "prefix-of-normals-one",
                            units == 3   ? "a part of the base's geometry, of which nodes coincide"
                            : units == 9 ? "geometry of slices without their normals"
                                         : "normals of the first slice, none of the others",
                            {"8.9.2", "8.10"});
    if (units == 3) {  // levels 0 and 1 are known
      c.parameters.base_levels = 3;
      c.parameters.geometry_level_ends = {2, 3, 4, 5};
      c.parameters.coefficient_level_ends = {3, 4, 5};
    }
    c.keep_units = units;
    c.levels = {1, 2, 4};
    c.groups = {1};
    cases.push_back(c);
  }
}

/// Values of which the mean of a node goes up to 2^17, in nodes of two, three and five points, all
/// levels predicted with the gain of mode 2.
void add_gains(std::vector<Case>& cases) {
  LightField large = field(sphere(5, 3, 10), 5, 1, 0);
  for (std::size_t p = 0; p < large.num_points(); ++p)
    for (std::size_t j = 0; j < 3; ++j) {
      const Voxel& v = large.positions[p];
      large.components[3 * p + j] = 11000 * (v[j] - 15) + 977 * (v[(j + 1) % 3] % 3);
    }
  CodingParameters parameters = with_steps(1, 6000);
  parameters.base_levels = 0;
  parameters.geometry_level_ends = parameters.coefficient_level_ends = {5};
  parameters.index = parameters.digest = false;
  const Bytes stream = edited(*pack(large, parameters), [](auto& units) {
    const auto set = *parse_sequence_parameter_set(units[0].payload);
    set_modes(first_of(units, UnitType::kCoefficients), set, {2, 2, 2, 2, 2});
  });
  Case c =
      case_of_stream("prediction-of-large-means",
                     "corrections so large that the last bit of a gain shows", {"8.7.6"}, stream);
  c.levels = {3, 4};
  cases.push_back(c);
}

}  // namespace

std::vector<Case> ordinary_cases() {
  std::vector<Case> cases;
  add_counts(cases);
  add_corners(cases);
  add_ordinary_prefixes(cases);
  add_gains(cases);
  return cases;
}

}  // namespace slf::conformance
