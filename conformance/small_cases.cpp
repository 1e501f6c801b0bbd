// SPDX-License-Identifier: Apache-2.0
// The smallest light fields that show something: a mistake is found in them in a moment.
#include <algorithm>

#include "conformance/cases.h"
#include "conformance/edit_units.h"
#include "conformance/fields.h"

namespace slf::conformance {
namespace {

using Strings = std::vector<std::string>;

Case small(const char* id, const char* purpose, Strings clauses, LightField field,
           CodingParameters parameters = {}) {
  parameters.index = false;
  Case c{id, purpose, std::move(clauses), std::move(field), std::move(parameters), {}, {},
         0,  false};
  return c;
}

/// Function 0 in group 0, the others in turn in those behind it.
CodingParameters in_groups(int functions, int groups, std::uint32_t step, int base_levels) {
  CodingParameters p = with_steps(functions, step);
  for (int k = 0; k < functions; ++k)
    p.group.push_back(k == 0 || groups == 1 ? 0 : 1 + k % (groups - 1));
  p.base_levels = base_levels;
  return p;
}

void add_normals(LightField& field, int bits, std::uint32_t widest) {
  Random random(21);
  field.normals.bits = bits;
  const std::uint32_t all = 1u << bits;
  std::uint32_t a = 0, b = 0;
  for (std::size_t p = 0; p < field.num_points(); ++p) {
    a = (a + all + random.below(widest) - widest / 2) % all;
    b = (b + all + random.below(p % 3 == 0 ? widest : 3) - 1) % all;
    field.normals.octahedral.push_back(
        {static_cast<std::uint16_t>(a), static_cast<std::uint16_t>(b)});
  }
}

void add_small_geometry(std::vector<Case>& cases) {
  CodingParameters ranges;
  ranges.base_levels = 0;
  ranges.geometry_level_ends = {1, 3, 4, 5};
  cases.push_back(small("small-noise", "sixty voxels, four level ranges", {"7.4", "8.4"},
                        field(scattered(60, 5, 17), 5, 0), ranges));
  cases.push_back(
      small("small-surface", "a small closed surface", {"8.4"}, field(sphere(4), 4, 0)));
  cases.push_back(small("fewest-contexts",
                        "31 points: tables of 2^10 contexts, whose groups collide",
                        {"8.4.2", "8.4.4"}, field(scattered(31, 9, 8), 9, 0)));
  cases.push_back(small("points-of-2-to-the-6",
                        "64 points: the bits of their number, not of the last's", {"8.4.2"},
                        field(scattered(64, 9, 8), 9, 0)));
  for (const int level : {9, 10})
    cases.push_back(small(level == 9 ? "history-direct" : "history-hashed",
                          level == 9 ? "voxels whose entries would collide if they were hashed"
                                     : "voxels whose entries collide, as they are hashed",
                          {"8.4.3"}, field(colliding_voxels(level), level + 1, 0)));
}

/// A light field on a deep grid: pairs of points at every distance.
LightField deep(int functions) {
  std::vector<Voxel> voxels;
  Random random(33);
  for (int i = 0; i < 21; ++i)
    for (int k = 0; k < 2; ++k) {
      Voxel v{};
      for (auto& c : v) c = static_cast<std::int32_t>(random.below(3) << i & 0x1FFFFF);
      voxels.push_back(v);
    }
  for (const Voxel& v : scattered(12, 21, 35)) voxels.push_back(v);
  return field(sorted(std::move(voxels)), 21, functions, 60000);
}

void add_deep(std::vector<Case>& cases) {
  CodingParameters p = in_groups(3, 2, 9, 0);
  p.coefficient_level_ends = {2, 7, 14, 21};
  Case whole =
      small("deep-grid", "components on a grid of 21 bits", {"8.6", "8.7.2", "8.7.6"}, deep(3), p);
  whole.levels = {1, 9, 20};
  cases.push_back(whole);
  p = in_groups(3, 2, 9, 3);
  p.max_slice_points = 15;
  p.coefficient_level_ends = {3, 21};
  Case scene =
      small("deep-scene", "slices on a grid of 21 bits", {"8.2", "8.6", "8.9"}, deep(3), p);
  scene.levels = {2, 12};
  cases.push_back(scene);
}

Case small_scene(const char* id, const char* purpose, Strings clauses) {
  CodingParameters p = in_groups(7, 3, 30, 2);
  p.coefficient_level_ends = {1, 2, 3, 4};
  p.geometry_level_ends = {2, 3, 4};
  p.max_slice_points = 60;
  return small(id, purpose, std::move(clauses), field(sphere(4, 3), 4, 7), p);
}

void add_small_scenes(std::vector<Case>& cases) {
  Case shared = small_scene("small-scene", "a base, slices that share states, three groups",
                            {"7.3", "8.1", "8.2", "8.7.2"});
  shared.levels = {1, 3};
  shared.groups = {2};
  shared.parameters.index = true;
  cases.push_back(shared);
  Case alone = small_scene("small-alone", "slices without shared states, normals of 12 bits",
                           {"8.1", "8.9", "8.10"});
  alone.parameters.slice_start = SliceStart::kBase;
  alone.levels = {3};
  add_normals(alone.field, 12, 4096);
  cases.push_back(alone);
  for (const bool vector : {true, false}) {
    Case plain = small_scene(
        vector ? "small-unpredicted" : "small-independent",
        vector ? "no prediction, several slices" : "the independent coder, several slices",
        {"7.6", vector ? "8.7.2" : "8.7.3"});
    plain.parameters.predict = !vector;
    plain.parameters.coefficients =
        vector ? CoefficientCoder::kVector : CoefficientCoder::kIndependent;
    cases.push_back(plain);
  }
  Case order =
      small_scene("small-slice-by-slice", "slices one after the other, without digests", {"7.1"});
  order.slice_by_slice = true;
  order.parameters.digest = false;
  cases.push_back(order);
}

void add_coefficients(std::vector<Case>& cases) {
  cases.push_back(small("small-vector", "groups of one and of eleven functions", {"8.7.2"},
                        field(sphere(3), 3, 12), in_groups(12, 2, 40, 0)));
  cases.push_back(small("small-flat", "most vectors are zero", {"8.7.2"}, field(sphere(4), 4, 12),
                        in_groups(12, 2, 400, 0)));
  cases.push_back(small("cells-of-many-functions", "cell rows before groups of eleven functions",
                        {"8.6.4", "8.7.2"}, field(sphere(3), 3, 12), in_groups(12, 2, 20, 1)));
  cases.push_back(small("group-of-140", "runs beyond the 31st; great values that fade", {"8.7.2"},
                        field(scattered(14, 3, 23), 3, 140, 400000), in_groups(140, 1, 3, 0)));
  CodingParameters p = in_groups(2, 1, 40, 0);
  p.coefficient_level_ends = {2, 4, 5};
  p.geometry_level_ends = {1, 5};
  cases.push_back(small("one-point-of-ranges",
                        "a point: row 0 in the first range, the others empty", {"7.1", "8.6.3"},
                        field({{9, 20, 3}}, 5, 2), p));
  Case last = small("late-merges", "no level above the third has a merge", {"8.6.3", "8.7.1"},
                    field(scattered(6, 2, 3), 5, 2), p);
  last.levels = {2, 4};
  cases.push_back(last);
  Case zeros =
      small("zeros-then-one", "a context of a probability below 2^-16, then the other value",
            {"8.3.2", "8.7.3"}, field(scattered(600, 6, 14), 6, 1, 0), in_groups(1, 1, 1, 0));
  std::fill(zeros.field.components.begin(), zeros.field.components.end(), 0);
  zeros.field.components[3 * 500] = 3000;
  zeros.parameters.coefficients = CoefficientCoder::kIndependent;
  zeros.parameters.coefficient_level_ends = {5, 6};
  cases.push_back(zeros);
  CodingParameters each = with_steps(16, 25);
  for (int k = 0; k < 16; ++k) each.group.push_back(k);
  each.base_levels = 0;
  for (int level = 1; level <= 4; ++level)
    each.coefficient_level_ends.push_back(level), each.geometry_level_ends.push_back(level);
  Case most = small("most-groups", "sixteen groups, a unit for every level", {"7.2", "7.6"},
                    field(scattered(20, 4, 5), 4, 16), each);
  most.groups = {1, 15, 16};
  cases.push_back(most);
}

/// Dense blocks beside single points, large values: what caps are for.
std::vector<Voxel> clumps() {
  std::vector<Voxel> voxels = {{31, 31, 31}, {0, 15, 15}, {15, 0, 14}, {9, 0, 0}, {9, 1, 0}};
  for (std::int32_t i = 0; i < 512; ++i) voxels.push_back({16 + i % 8, 8 + i / 8 % 8, i / 64});
  for (std::int32_t i = 0; i < 64; ++i) voxels.push_back({i % 4, i / 4 % 4, i / 16});
  return sorted(voxels);
}

void add_values(std::vector<Case>& cases) {
  cases.push_back(small("clumps", "rows of great and of small weight beside each other", {"8.7.2"},
                        field(clumps(), 5, 3, 90000), in_groups(3, 1, 1, 0)));
  Case mean = small("large-means", "means beyond 2^17", {"8.7.6"}, field(sphere(3), 3, 2, 4000000),
                    in_groups(2, 1, 4000, 0));
  mean.levels = {1, 2};
  cases.push_back(mean);
  CodingParameters steps = in_groups(6, 2, 1, 0);
  steps.step = {{70000, 3, 1}, {9, 9, 9}, {9, 9, 9}, {9, 9, 9}, {5, 6, 7}, {99999, 1, 400}};
  Case unequal = small("small-steps", "steps above 2^16; runs of functions that share theirs",
                       {"7.2", "8.7.4"}, field(scattered(30, 4, 6), 4, 6, 500000), steps);
  unequal.field.header.shift = {15, 7, 7, 7, 0, 1};
  cases.push_back(unequal);
}

void add_headers(std::vector<Case>& cases) {
  const std::vector<Voxel> few = {{0, 1, 2}, {3, 3, 3}, {7, 7, 7}};
  const auto add = [&](const char* id, const char* purpose, const auto& edit) {
    LightField f;
    f.header.grid = {{0, 0, 0}, 1, 3};
    f.positions = few;
    edit(f.header);
    f.header.num_functions = f.header.basis.num_functions();
    LightField filled = field(few, 3, f.header.num_functions, 400);
    filled.header = f.header;
    Random random(77);
    for (std::size_t i = 0; i < filled.components.size(); ++i)  // colours within their range
      filled.components[i] = static_cast<std::int32_t>(
          i / 3 % static_cast<std::size_t>(f.header.num_functions) == 0
              ? (110 + random.below(30)) << (f.header.shift.empty() ? 0 : f.header.shift[0])
              : random.below(9) - 4);
    cases.push_back(
        small(id, purpose, {"6.3", "7.2"}, filled, with_steps(f.header.num_functions, 1)));
  };
  add("header-order-1", "B-splines of order 1, many over theta", [](auto& h) {
    h.basis = {BasisId::kBspline, 1, 4, 0};
    h.up = UpAxis::kPlusX;
  });
  add("header-order-2", "B-splines of order 2 over both axes, reflected", [](auto& h) {
    h.basis = {BasisId::kBspline, 2, 2, 2};
    h.directions = Directions::kReflected;
    h.up = UpAxis::kMinusX;
    h.normal_cell_log2 = 2;
  });
  add("header-order-4", "B-splines of order 4, many over gamma; a gamma range of one value",
      [](auto& h) {
        h.basis = {BasisId::kBspline, 4, 0, 6};
        h.up = UpAxis::kPlusY;
        h.gamma_min_q7 = h.gamma_max_q7 = -127;
      });
  add("header-degree-10", "harmonics of degree 10 in linear light", [](auto& h) {
    h.basis = {BasisId::kHarmonics, 2, 0, 0, 10};
    h.transfer = Transfer::kLinear;
    h.up = UpAxis::kMinusZ;
    h.right_handed = false;
    h.gamma_min_q7 = 0;
    h.gamma_max_q7 = 126;
  });
  add("header-degree-0", "one function; metres; a grid away from the origin", [](auto& h) {
    h.basis = {BasisId::kHarmonics, 2, 0, 0, 0};
    h.up = UpAxis::kUnknown;
    h.metres_per_unit = 1e-3;
    h.grid = {{1e6, -0.125, 3}, 1e-300, 3};
    h.colour = ColourTransform::kOpponent;
    h.shift = {6};
  });
}

}  // namespace

std::vector<Case> small_cases() {
  std::vector<Case> cases;
  add_small_geometry(cases);
  add_deep(cases);
  add_small_scenes(cases);
  add_coefficients(cases);
  add_values(cases);
  add_headers(cases);
  return cases;
}

}  // namespace slf::conformance
