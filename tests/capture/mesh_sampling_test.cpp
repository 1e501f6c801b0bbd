// SPDX-License-Identifier: Apache-2.0
// What a grid makes of a mesh: a layer one voxel thick, on the surface, with its outside out.
#include "capture/mesh_sampling.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "capture/density.h"
#include "capture/mesh_sides.h"
#include "capture/mesh_triangles.h"
#include "mesh_files.h"

namespace slf::mesh_sampling_test {
namespace {

using namespace test;
using ::testing::HasSubstr;

Mesh cube() { return *mesh_in("cube.obj", cube_obj()); }

Grid grid_of(const Mesh& mesh, double step) { return *choose_grid(bounding_box(mesh), 3, 0, step); }

TEST(SampleMesh, ACubeBecomesItsOuterVoxelsEachOnce) {
  const Mesh mesh = cube();
  const Grid grid = grid_of(mesh, 0.125);  // 9 voxels along a side
  const auto points = sample_mesh(mesh, grid);
  ASSERT_TRUE(points) << points.error().message;
  const VoxelCloud voxels = voxelise_on(*points, grid);
  EXPECT_EQ(voxels.positions.size(), 9u * 9 * 9 - 7 * 7 * 7);
}

/// z = 0.3 x + 0.2 y over the unit square, as n x n x 2 triangles.
Mesh slope(std::size_t n) {
  Mesh mesh;
  for (std::size_t j = 0; j <= n; ++j)
    for (std::size_t i = 0; i <= n; ++i) {
      const float x = static_cast<float>(i) / static_cast<float>(n),
                  y = static_cast<float>(j) / static_cast<float>(n);
      mesh.vertices.positions.push_back({x, y, 0.3f * x + 0.2f * y});
    }
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (n + 1) + i),
                 b = a + static_cast<std::uint32_t>(n) + 1;
      mesh.triangles.push_back({a, a + 1, b});
      mesh.triangles.push_back({b, a + 1, b + 1});
    }
  return mesh;
}

TEST(SampleMesh, ALayerIsOneVoxelThickWithoutHolesHoweverFineTheTriangles) {
  for (const std::size_t n : std::initializer_list<std::size_t>{1, 7, 300}) {
    const Mesh mesh = slope(n);
    const Grid grid = grid_of(mesh, 1.0 / 64);
    const auto points = sample_mesh(mesh, grid);
    ASSERT_TRUE(points) << points.error().message;
    const VoxelCloud voxels = voxelise_on(*points, grid);
    std::set<std::pair<int, int>> columns;
    for (const Voxel& v : voxels.positions) columns.emplace(v[0], v[1]);
    EXPECT_EQ(columns.size(), 65u * 65) << n;
    EXPECT_EQ(voxels.positions.size(), 65u * 65) << n;
  }
}

TEST(SampleMesh, PointsLieOnTheSurfaceWithItsNormal) {
  const Mesh mesh = slope(3);
  const auto points = sample_mesh(mesh, grid_of(mesh, 1.0 / 32));
  ASSERT_TRUE(points) << points.error().message;
  const double length = std::sqrt(1 + 0.09 + 0.04);
  for (std::size_t i = 0; i < points->positions.size(); ++i) {
    const auto& p = points->positions[i];
    EXPECT_NEAR(double{p[2]}, 0.3 * double{p[0]} + 0.2 * double{p[1]}, 1e-5);
    EXPECT_NEAR(double{points->normals[i][2]}, 1 / length, 1e-5);
  }
}

TEST(SampleMesh, TrianglesWithoutAreaGiveNothing) {
  Mesh mesh;
  mesh.vertices.positions = {{0, 0, 0}, {1, 1, 1}, {0.5f, 0.5f, 0.5f}};
  mesh.triangles = {{0, 1, 2}, {0, 0, 0}, {1, 1, 0}};
  const auto points = sample_mesh(mesh, grid_of(mesh, 0.1));
  ASSERT_TRUE(points) << points.error().message;
  EXPECT_TRUE(points->positions.empty());
}

TEST(SampleMesh, AStepThatTakesTooManyPointsIsRefusedBeforeItBegins) {
  const Mesh mesh = cube();
  const auto points = sample_mesh(mesh, grid_of(mesh, 1e-5));
  ASSERT_FALSE(points);
  EXPECT_THAT(points.error().message, HasSubstr("voxel size"));
}

TEST(SampleMesh, FacesThatPointInwardsAreTurned) {
  Mesh mesh = cube();
  const std::vector<Camera> cameras{camera_at(4, 64)};
  EXPECT_FALSE(turn_towards(cameras, mesh));
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_TRUE(turn_towards(cameras, mesh));
  EXPECT_NEAR(signed_volume(mesh), 1, 1e-6);
}

TEST(MeshCapture, IsSampledAtItsPhotographsDensityAndAgainOnAnotherGrid) {
  const TemporaryDirectory directory;
  const Image image{64, 64, 3, std::vector<std::uint8_t>(64 * 64 * 3, 90)};
  std::filesystem::create_directories(directory / "images");
  ASSERT_TRUE(write_png(directory / "images/a.png", image));
  write_text(directory / "mesh.glb", cube_glb());
  write_text(directory / "cameras.json", R"({"cameras": [{"image": "images/a.png", "width": 64,
    "height": 64, "K": [[64, 0, 32], [0, 64, 32], [0, 0, 1]],
    "R": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "t": [0, 0, 2]}]})");
  const auto capture = load_capture(directory.path());
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_EQ(capture->mesh.triangles.size(), 12u);
  EXPECT_EQ(capture->cloud.normals.size(), capture->cloud.positions.size());
  const std::vector<int> all{0};
  const Density density = choose_density(*capture, all);
  EXPECT_EQ(density.spacing, 0) << "a surface has points anywhere";
  EXPECT_NEAR(density.pixel, 1.5 / 64, 1e-6) << "of the one face that is seen";
  const auto finer = voxelise_geometry(*capture, capture->cloud, all, 8, 0);
  ASSERT_TRUE(finer) << finer.error().message;
  EXPECT_EQ(finer->positions.size(), 256u * 256 * 256 - 254u * 254 * 254);
}

}  // namespace
}  // namespace slf::mesh_sampling_test
