// SPDX-License-Identifier: Apache-2.0
// All streams that must decode; here those of geometry alone and of beginnings.
#include "conformance/cases.h"
#include "conformance/fields.h"

namespace slf::conformance {
namespace {

/// One voxel in each of 8 x 8 x 8 blocks of 2 x 2 x 2 but some.
std::vector<Voxel> one_in_most_blocks() {
  std::vector<Voxel> voxels;
  for (const Voxel& block : lattice(8, 8, 8)) {
    const auto seed = static_cast<std::uint32_t>(block[0] * 73 + block[1] * 179 + block[2] * 283);
    const std::uint32_t chance = seed * 2654435761u;
    if ((chance >> 20 & 7) == 0) continue;
    Voxel v{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      v[axis] = 2 * block[axis] + static_cast<std::int32_t>(chance >> (29 + axis) & 1);
    voxels.push_back(v);
  }
  return voxels;
}

void add_octrees(std::vector<Case>& cases) {
  const auto add = [&](std::string id, std::string purpose, std::vector<Voxel> voxels, int bits) {
    cases.push_back(case_of(std::move(id), std::move(purpose), {"7.3", "8.4"},
                            field(std::move(voxels), bits, 0)));
  };
  add("one-point", "smallest light field: no level to code", {{5, 2, 7}}, 3);
  add("two-points-21-bit", "corners of the largest grid",
      {{0, 0, 0}, {(1 << 21) - 1, (1 << 21) - 1, (1 << 21) - 1}}, 21);
  add("full-cube", "every voxel occupied: probabilities near 1", lattice(16, 16, 16), 4);
  add("only-children", "most nodes around a node, each of one child", one_in_most_blocks(), 4);
  add("line", "one row", lattice(256, 1, 1), 8);
  add("plane", "one layer", lattice(64, 64, 1), 6);
  add("scattered", "no structure", scattered(3000, 9, 3), 9);
  add("scattered-21-bit", "history tables are hashed", scattered(400, 21, 4), 21);
  add("sphere-dense", "closed surface", sphere(7), 7);
  add("sphere-thinned", "surface with holes", sphere(7, 3), 7);
}

void add_cut_streams(std::vector<Case>& cases) {
  for (const std::size_t units : {2u, 4u, 5u, 7u, 8u}) {
    Case c = case_of("prefix-" + std::to_string(units),
                     "a stream cut after " + std::to_string(units) + " units", {"7.1", "8.9"},
                     field(sphere(5), 5, 4), with_steps(4, 16));
    c.keep_units = units;
    c.parameters.group = {0, 1, 1, 1};
    c.parameters.geometry_level_ends = {3, 5};
    c.parameters.coefficient_level_ends = {4, 5};
    cases.push_back(c);
  }
}

}  // namespace

std::vector<Case> valid_cases() {
  std::vector<Case> cases;
  const auto append = [&](const std::vector<Case>& more) {
    cases.insert(cases.end(), more.begin(), more.end());
  };
  add_octrees(cases);
  for (const auto& make :
       {component_cases, header_cases, scene_cases, apart_cases, layer_cases, small_cases,
        edited_cases, transform_cases, attribute_cases, frame_cases, frame_context_cases,
        empty_frame_cases, frame_attribute_cases, moved_frame_cases, growth_cases, level_cases,
        ordinary_cases, limit_cases})
    append(make());
  add_cut_streams(cases);
  append(texture_cases());
  return cases;
}

}  // namespace slf::conformance
