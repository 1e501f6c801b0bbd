// SPDX-License-Identifier: Apache-2.0
// Light fields of integers for tests: small, of every shape that has gone wrong somewhere.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "geometry/morton.h"
#include "slf/types.h"

namespace slf::test {

/// Distinct voxels, Morton order.
inline std::vector<Voxel> sorted_distinct(std::vector<Voxel> voxels) {
  std::sort(voxels.begin(), voxels.end(),
            [](const Voxel& a, const Voxel& b) { return morton(a) < morton(b); });
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  return voxels;
}

inline std::vector<std::uint64_t> codes(const std::vector<Voxel>& voxels) {
  std::vector<std::uint64_t> morton_codes;
  for (const Voxel& v : voxels) morton_codes.push_back(morton(v));
  return morton_codes;
}

inline std::vector<Voxel> random_cloud(std::size_t count, int bits, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Voxel> voxels;
  for (std::size_t i = 0; i < count; ++i) {
    Voxel v;
    for (auto& c : v) c = static_cast<std::int32_t>(random() >> (32 - bits));
    voxels.push_back(v);
  }
  return sorted_distinct(voxels);
}

/// The voxels a sphere's surface passes through.
inline std::vector<Voxel> sphere_cloud(int bits) {
  const std::int32_t side = 1 << bits, r = side / 2 - 1;
  std::vector<Voxel> voxels;
  for (std::int32_t z = 0; z < side; ++z)
    for (std::int32_t y = 0; y < side; ++y)
      for (std::int32_t x = 0; x < side; ++x) {
        const std::int32_t dx = x - r, dy = y - r, dz = z - r;
        const std::int32_t d = dx * dx + dy * dy + dz * dz;
        if (d <= r * r && d > (r - 1) * (r - 1)) voxels.push_back({x, y, z});
      }
  return sorted_distinct(voxels);
}

/// Sums of weights as CodeWeights takes them: of codes that weigh alike.
inline std::vector<std::uint32_t> weights_alike(std::size_t codes, std::uint32_t weight) {
  std::vector<std::uint32_t> before;
  for (std::size_t i = 0; i <= codes; ++i) before.push_back(static_cast<std::uint32_t>(i) * weight);
  return before;
}

/// The same of powers of two by chance.
inline std::vector<std::uint32_t> weights_by_chance(std::size_t codes, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<std::uint32_t> before{0};
  for (std::size_t i = 0; i < codes; ++i) before.push_back(before.back() + (1u << random() % 8));
  return before;
}

/// Distinct codes of the cells that hold the points, 3 * below bits shorter.
inline std::vector<std::uint64_t> cells_of(const std::vector<std::uint64_t>& points, int below) {
  std::vector<std::uint64_t> cells;
  for (const std::uint64_t code : points)
    if (cells.empty() || cells.back() != code >> (3 * below)) cells.push_back(code >> (3 * below));
  return cells;
}

/// First points of the rows of a tree, and their end: rows that are points.
inline std::vector<std::uint32_t> one_row_a_point(std::size_t points) {
  std::vector<std::uint32_t> first(points + 1);
  std::iota(first.begin(), first.end(), 0u);
  return first;
}

/// A part of a scene: its points and the number of the first of its cells.
struct TestSlice {
  std::vector<std::uint64_t> points;
  std::size_t first_cell = 0;
};

/// Runs of cells, as many of each as of the others.
inline std::vector<TestSlice> slices_of(const std::vector<std::uint64_t>& points, int below,
                                        std::size_t count) {
  const auto cells = cells_of(points, below);
  std::vector<TestSlice> slices;
  for (std::size_t i = 0, cell = 0; i < points.size(); ++i) {
    if (points[i] >> (3 * below) != cells[cell]) ++cell;
    if (const std::size_t slice = cell * count / cells.size();
        slices.empty() || (slices.back().first_cell * count / cells.size()) != slice)
      slices.push_back({{}, cell});
    slices.back().points.push_back(points[i]);
  }
  return slices;
}

struct NamedCloud {
  std::string name;
  int bits;
  std::vector<Voxel> voxels;
};

/// In the output of parameterised tests.
inline void PrintTo(const NamedCloud& cloud, std::ostream* out) { *out << cloud.name; }

inline std::vector<NamedCloud> clouds_of_every_shape() {
  std::vector<NamedCloud> clouds = {
      {"one_point", 3, {{5, 0, 7}}},
      {"one_point_21_bit", 21, {{(1 << 21) - 1, 0, 1 << 20}}},
      {"two_corners_21_bit", 21, {{0, 0, 0}, {(1 << 21) - 1, (1 << 21) - 1, (1 << 21) - 1}}},
      {"full_cube", 3, {}},
      {"line", 8, {}},
      {"plane", 6, {}},
      {"random", 7, random_cloud(3000, 7, 1)},
      {"random_21_bit", 21, random_cloud(500, 21, 2)},
      {"one_bit", 1, {{0, 0, 0}, {1, 1, 1}}},
      {"sphere", 6, sphere_cloud(6)}};
  for (std::int32_t i = 0; i < 512; ++i) clouds[3].voxels.push_back({i & 7, i >> 3 & 7, i >> 6});
  for (std::int32_t i = 0; i < 256; ++i) clouds[4].voxels.push_back({i, 17, 200});
  for (std::int32_t i = 0; i < 4096; ++i) clouds[5].voxels.push_back({i & 63, i >> 6, 31});
  for (auto& cloud : clouds) cloud.voxels = sorted_distinct(cloud.voxels);
  return clouds;
}

/// Smooth components with some noise: [P][K][3], |value| below `size`.
inline std::vector<std::int32_t> smooth_components(const std::vector<Voxel>& voxels, int functions,
                                                   int size, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<std::int32_t> components;
  for (const Voxel& v : voxels)
    for (int k = 0; k < functions; ++k)
      for (int c = 0; c < 3; ++c) {
        const std::int32_t wave = (v[0] * (k + 1) + v[1] * (c + 2) + v[2] * 3) % size - size / 2;
        const auto noise = static_cast<std::int32_t>(random() % 5) - 2;
        components.push_back(k == 0 ? wave + noise : (wave / (4 * k) + noise) / (1 + k / 4));
      }
  return components;
}

inline LightField make_field(const std::vector<Voxel>& voxels, int bits, int functions,
                             int size = 1000, std::uint32_t seed = 7) {
  LightField field;
  field.header.grid = {{0, 0, 0}, 1, bits};
  field.header.num_functions = functions;
  field.header.has_basis = false;
  field.positions = voxels;
  field.components = smooth_components(voxels, functions, size, seed);
  return field;
}

}  // namespace slf::test
