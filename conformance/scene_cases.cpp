// SPDX-License-Identifier: Apache-2.0
// A base and slices; what was cut; parts of space.
#include "conformance/cases.h"
#include "conformance/fields.h"
#include "geometry/weight_classes.h"

namespace slf::conformance {
namespace {

/// Some 1,400 points that meet all of the root's children.
std::vector<Voxel> ball() { return sphere(6, 0, 11); }

/// Four of the eight children of the root.
std::vector<Voxel> half_ball() {
  std::vector<Voxel> voxels = ball();
  std::erase_if(voxels, [](const Voxel& v) { return v[2] >= 32; });
  return voxels;
}

/// Three groups and level ranges above and below the base.
Case scene_case(const char* id, const char* purpose, int base_levels, std::uint32_t slice_points) {
  Case c{id,
         purpose,
         {"7.3", "8.2", "8.9"},
         field(ball(), 6, 6),
         with_steps(6, 40),
         {2, 3, 4, 5},
         {1, 2},
         0,
         false};
  c.parameters.group = {0, 1, 1, 2, 2, 2};
  c.parameters.geometry_level_ends = {2, 5, 6};
  c.parameters.coefficient_level_ends = {2, 4, 6};
  c.parameters.base_levels = base_levels;
  c.parameters.max_slice_points = slice_points;
  c.regions = {{{0, 0, 0}, {26, 31, 63}}, {{60, 60, 60}, {90, 90, 90}}};
  return c;
}

void add_scenes(std::vector<Case>& cases) {
  cases.push_back(scene_case("base", "a base and one slice", 3, 1u << 20));
  cases.push_back(scene_case("base-one-level", "a base of one level", 1, 1u << 20));
  cases.push_back(scene_case("base-all-but-one-level", "every cell has few points", 5, 1u << 20));
  cases.push_back(
      scene_case("scene-shared", "slices that start from the first one's states", 3, 160));
  Case alone = scene_case("scene-alone", "slices that start from the base's states", 3, 160);
  alone.parameters.slice_start = SliceStart::kBase;
  cases.push_back(alone);
  Case independent =
      scene_case("scene-independent", "the independent coder, shared states", 3, 280);
  independent.parameters.coefficients = CoefficientCoder::kIndependent;
  cases.push_back(independent);
  Case unpredicted = scene_case("scene-unpredicted", "no prediction; normals; no index", 2, 280);
  unpredicted.parameters.predict = unpredicted.parameters.index = false;
  unpredicted.field.normals.bits = 5;
  for (std::size_t p = 0; p < unpredicted.field.num_points(); ++p)
    unpredicted.field.normals.octahedral.push_back(
        {static_cast<std::uint16_t>(p % 32), static_cast<std::uint16_t>(p / 5 % 32)});
  cases.push_back(unpredicted);
  Case order = scene_case("scene-slice-by-slice", "slices one after the other", 3, 160);
  order.parameters.index = false;
  order.slice_by_slice = true;
  cases.push_back(order);
  for (const bool most : {false, true}) {
    Case weight =
        scene_case(most ? "base-weight-most" : "base-weight-least",
                   "cells that weigh as much, or as little, as they may", most ? 1 : 4, 160);
    weight.clauses = {"8.4.5", "8.6.2"};
    weight.parameters.base_weight = most ? 1u << 21 : 1;
    cases.push_back(weight);
  }
  Case heaviest = scene_case("base-class-most", "four cells of the highest class", 1, 80);
  heaviest.clauses = {"8.4.5", "8.6.4"};
  heaviest.field = field(half_ball(), 6, 6);
  heaviest.parameters.base_weight = 1u << kMostWeightClass;
  cases.push_back(heaviest);
  Case geometry = scene_case("scene-geometry", "slices without components", 3, 160);
  geometry.field = field(ball(), 6, 0);
  geometry.parameters.step.clear();
  geometry.parameters.group.clear();
  geometry.groups.clear();
  cases.push_back(geometry);
}

void add_cuts(std::vector<Case>& cases) {
  const auto add = [&](const char* id, const char* purpose, int levels, int groups,
                       std::optional<VoxelBox> region, std::uint64_t max_bytes = 0) {
    Case c = scene_case(id, purpose, 3, 160);
    c.clauses = {"7.2", "8.9"};
    c.truncated.emplace();
    c.truncated->levels = levels;
    c.truncated->groups = groups;
    c.truncated->region = region;
    c.truncated->max_bytes = max_bytes;
    c.levels = {2, 4};
    c.groups = {1};
    cases.push_back(c);
  };
  add("cut-levels", "a level range left out", 4, 0, {});
  add("cut-levels-of-base", "no slice left", 2, 0, {});
  add("cut-groups", "a group left out", 0, 2, {});
  add("cut-region", "slices left out", 0, 0, VoxelBox{{0, 0, 0}, {26, 31, 63}});
  add("cut-all", "levels, a group and slices left out", 5, 1, VoxelBox{{0, 0, 0}, {26, 31, 63}});
  add("cut-bytes", "units left out from the end", 0, 0, {}, 1500);
}

void add_scene_prefixes(std::vector<Case>& cases) {
  for (const std::size_t units : {3u, 5u, 6u, 9u, 11u, 14u, 17u, 22u, 30u}) {
    Case c =
        scene_case(("scene-prefix-" + std::to_string(units)).c_str(), "a scene cut short", 3, 280);
    c.parameters.index = true;
    c.regions.clear();
    c.keep_units = units;
    cases.push_back(c);
  }
  Case unpredicted =
      scene_case("scene-prefix-unpredicted", "the same, its cells of one colour", 3, 280);
  unpredicted.parameters.predict = false;
  unpredicted.keep_units = 11;
  cases.push_back(unpredicted);
}

}  // namespace

std::vector<Case> scene_cases() {
  std::vector<Case> cases;
  add_scenes(cases);
  add_cuts(cases);
  add_scene_prefixes(cases);
  return cases;
}

}  // namespace slf::conformance
