// SPDX-License-Identifier: Apache-2.0
// Meshes of more points than are held at once: cube by cube they become what they are as a whole.
#include "capture/mesh_parts.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "capture/mesh_sampling.h"
#include "capture/mesh_triangles.h"
#include "geometry/morton.h"

namespace slf::mesh_parts_test {
namespace {

using ::testing::HasSubstr;

/// A torus, with colours that vary over it.
Mesh torus(int n) {
  Mesh mesh;
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>((i % n) * n + j % n); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * j / n;
      const double r = 1 + 0.4 * std::cos(v);
      mesh.vertices.positions.push_back({static_cast<float>(r * std::cos(u)),
                                         static_cast<float>(r * std::sin(u)),
                                         static_cast<float>(0.4 * std::sin(v))});
      mesh.vertices.colours.push_back(
          {static_cast<std::uint8_t>(255 * i / n), static_cast<std::uint8_t>(255 * j / n), 77});
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

TEST(MeshParts, AreTheVoxelsOfTheWholeInMortonOrder) {
  for (const int n : {7, 90}) {
    const Mesh mesh = torus(n);
    const Grid grid = *choose_grid(bounding_box(mesh), mesh.triangles.size(), 0, 2.8 / 600);
    ASSERT_GT(grid.bits, kCubeLog2);  // several cubes, the last of an axis not full
    const auto sampled = sample_mesh(mesh, grid);
    ASSERT_TRUE(sampled) << sampled.error().message;
    const VoxelCloud whole = voxelise_on(*sampled, grid);
    ASSERT_GT(whole.positions.size(), 300'000u);
    std::size_t p = 0, other = 0;
    const auto done = for_each_mesh_voxel(mesh, grid, [&](const OccupiedVoxel& voxel) {
      if (p < whole.positions.size())
        other += voxel.code != morton(whole.positions[p]) || voxel.normal != whole.normals[p] ||
                 voxel.colour != whole.colours[p];
      ++p;
    });
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(p, whole.positions.size()) << n;
    EXPECT_EQ(other, 0u) << n;
  }
}

TEST(MeshParts, FacesTooLargeForTheirGridAreRefusedBeforeTheyAreSampled) {
  Mesh mesh = torus(40);
  for (auto& triangle : mesh.triangles) triangle = {0, 400, 800};  // each across all cubes
  const Grid grid = *choose_grid(bounding_box(mesh), mesh.triangles.size(), 21, 0);
  const auto done = for_each_mesh_voxel(mesh, grid, [](const OccupiedVoxel&) { FAIL(); });
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().message, HasSubstr("too small for its faces"));
}

TEST(MeshParts, FacesOnTopOfEachOtherAreRefusedBeforeTheyAreSampled) {
  Mesh mesh = torus(4);
  const Grid grid = *choose_grid(bounding_box(mesh), mesh.triangles.size(), 10, 0);
  mesh.triangles.assign(100000, mesh.triangles.front());
  const auto done = for_each_mesh_voxel(mesh, grid, [](const OccupiedVoxel&) { FAIL(); });
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().message, HasSubstr("too small for its faces"));
}

}  // namespace
}  // namespace slf::mesh_parts_test
