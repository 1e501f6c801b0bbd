// SPDX-License-Identifier: Apache-2.0
// Points between the points of a cloud: docs/captures.md, "Density".
#include "capture/densify.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "capture/voxelise.h"

namespace slf::densify_test {
namespace {

/// Points of the unit sphere, evenly.
PointCloud sphere(int count) {
  PointCloud cloud;
  const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z);
    cloud.positions.push_back(
        {float(r * std::cos(turn * i)), float(r * std::sin(turn * i)), float(z)});
    cloud.colours.push_back({std::uint8_t(z > 0 ? 255 : 0), 0, 0});
  }
  cloud.normals = cloud.positions;
  return cloud;
}

/// n x n points of the square [0, 1] at z = 0, and a camera that sees a pixel of 1 / 64 there.
Capture square(int n) {
  Capture capture;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      capture.cloud.positions.push_back({float(i) / float(n - 1), float(j) / float(n - 1), 0});
      capture.cloud.normals.push_back({0, 0, -1});
    }
  Camera camera;
  camera.width = camera.height = 256;
  camera.fx = camera.fy = 256;
  camera.cx = camera.cy = 32;
  camera.translation = {0, 0, 4};
  capture.cameras.push_back(camera);
  return capture;
}

const std::vector<int> kAll{0};

TEST(Densify, ACoarseSphereBecomesAClosedLayerOnTheSphere) {
  const PointCloud coarse = sphere(2000);
  const double spacing = 0.085;
  ASSERT_TRUE(on_even_surface(coarse, spacing));
  const Grid grid{{-1, -1, -1}, 0.025, 7};
  const PointCloud dense = densify(coarse, spacing, grid, 1);
  for (const auto& p : dense.positions)
    EXPECT_NEAR(std::hypot(p[0], p[1], p[2]), 1, 0.6 * grid.step);
  // One voxel for every line along the axis that the surface faces most: the mean of the greatest
  // component of a normal is 0.83.
  const double layer = 0.83 * 4 * std::numbers::pi / (grid.step * grid.step);
  EXPECT_NEAR(double(dense.positions.size()), layer, 0.04 * layer);
  ASSERT_EQ(dense.colours.size(), dense.positions.size());
  for (std::size_t i = 0; i < dense.colours.size(); ++i)
    if (std::abs(dense.positions[i][2]) > 0.1f) {
      EXPECT_EQ(dense.colours[i][0] == 255, dense.positions[i][2] > 0);
    }
  EXPECT_EQ(densify(coarse, spacing, grid, 4).positions, dense.positions);
}

TEST(Densify, ARimStaysWhereItIs) {
  const Capture capture = square(21);
  const PointCloud dense = densify(capture.cloud, 0.05, {{-0.5, -0.5, -0.5}, 0.0125, 8}, 1);
  float least = 1, most = 0;
  for (const auto& p : dense.positions) {
    least = std::min({least, p[0], p[1]});
    most = std::max({most, p[0], p[1]});
    EXPECT_EQ(p[2], 0);
  }
  EXPECT_GE(least, -0.026);
  EXPECT_LE(least, 0);
  EXPECT_LE(most, 1.026);
  EXPECT_GE(most, 1);
  EXPECT_GE(dense.positions.size(), 81u * 81) << "no hole";
}

TEST(Densify, IsByItselfWhereAnEvenSurfaceIsCoarserThanThePhotographs) {
  const Capture coarse = square(17);  // four pixels
  const DensifySettings automatic{Densify::kAuto};
  const auto voxels = voxelise_geometry(coarse, coarse.cloud, kAll, 0, 0, automatic);
  ASSERT_TRUE(voxels) << voxels.error().message;
  EXPECT_TRUE(voxels->density.densified);
  EXPECT_NEAR(voxels->grid.step, 1.0 / 64, 1e-6);
  EXPECT_GE(voxels->positions.size(), 65u * 65);
  EXPECT_EQ(voxels->normals.size(), voxels->positions.size());
  EXPECT_FALSE(voxelise_geometry(coarse, coarse.cloud, kAll, 0, 0)->density.densified);
  EXPECT_FALSE(voxelise_geometry(coarse, coarse.cloud, kAll, 5, 0, automatic)->density.densified);
  EXPECT_TRUE(
      voxelise_geometry(coarse, coarse.cloud, kAll, 5, 0, {Densify::kOn})->density.densified);

  const Capture nearly = square(40);  // 1.6 pixels
  EXPECT_FALSE(voxelise_geometry(nearly, nearly.cloud, kAll, 0, 0, automatic)->density.densified);
  EXPECT_TRUE(voxelise_geometry(nearly, nearly.cloud, kAll, 0, 0, {Densify::kAuto, 1.25})
                  ->density.densified);
}

TEST(Densify, ACloudInAVolumeIsNoSurfaceAndDensifiedIfAskedAlone) {
  Capture capture = square(2);
  capture.cloud = {};
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i) {
    std::array<float, 3> p{};
    for (float& x : p) x = float(random() % 4096) / 4096;
    capture.cloud.positions.push_back(p);
    capture.cloud.normals.push_back({0, 0, -1});
  }
  EXPECT_FALSE(
      voxelise_geometry(capture, capture.cloud, kAll, 0, 0, {Densify::kAuto})->density.densified);
  EXPECT_TRUE(
      voxelise_geometry(capture, capture.cloud, kAll, 0, 0, {Densify::kOn})->density.densified);
}

TEST(Densify, AGridMuchTooFineIsRefused) {
  const Capture capture = square(11);
  const auto voxels = voxelise_geometry(capture, capture.cloud, kAll, 16, 0, {Densify::kOn});
  ASSERT_FALSE(voxels);
  EXPECT_NE(voxels.error().message.find("too fine"), std::string::npos);
  const Capture few = square(2);  // few points are far apart
  EXPECT_FALSE(voxelise_geometry(few, few.cloud, kAll, 12, 0, {Densify::kOn}));
}

}  // namespace
}  // namespace slf::densify_test
