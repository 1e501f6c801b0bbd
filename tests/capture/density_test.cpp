// SPDX-License-Identifier: Apache-2.0
// Voxels of a cloud and of its photographs: as large as a pixel, no finer than the points.
#include "capture/density.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "mesh_files.h"

namespace slf::density_test {
namespace {

using namespace test;
using ::testing::HasSubstr;

/// n x n points of the square [-0.5, 0.5] at z = 0, which camera_at faces.
Capture square(int n, std::vector<Camera> cameras) {
  Capture capture;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      capture.cloud.positions.push_back({static_cast<float>(i) / static_cast<float>(n - 1) - 0.5f,
                                         static_cast<float>(j) / static_cast<float>(n - 1) - 0.5f,
                                         0});
      capture.cloud.normals.push_back({0, 0, -1});
    }
  capture.cameras = std::move(cameras);
  return capture;
}

TEST(Density, IsThePixelOfTheSharpestCameraThatFacesThePoints) {
  Camera behind = camera_at(1, 400);
  behind.rotation = {{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};  // the other side, closest of all
  const Capture capture = square(200, {camera_at(8, 64), camera_at(4, 64), behind});
  const std::vector<int> all{0, 1, 2}, far{0};
  const Density density = choose_density(capture, all);
  EXPECT_NEAR(density.pixel, 4.0 / 64, 1e-9);
  EXPECT_NEAR(density.voxel_size, kPixelsPerVoxel * density.pixel, 1e-9);
  EXPECT_FALSE(density.limited_by_cloud);
  EXPECT_NEAR(choose_density(capture, far).pixel, 8.0 / 64, 1e-9) << "only the input cameras count";
}

TEST(Density, IsNoFinerThanTheCloud) {
  const Capture capture = square(11, {camera_at(4, 640)});
  const std::vector<int> all{0};
  const Density density = choose_density(capture, all);
  EXPECT_TRUE(density.limited_by_cloud);
  EXPECT_NEAR(density.spacing, 0.1, 1e-6);
  EXPECT_GT(density.voxel_size, 0.04);
  EXPECT_LT(density.voxel_size, 0.1);
  const auto voxels = voxelise_geometry(capture, capture.cloud, all, 0, 0);
  ASSERT_TRUE(voxels) << voxels.error().message;
  EXPECT_EQ(voxels->positions.size(), 121u) << "no point is lost";
  EXPECT_EQ(voxels->density.voxel_size, voxels->grid.step);
}

TEST(Density, ADenseCloudBecomesALayerOneVoxelThickWithoutHoles) {
  Capture capture;
  constexpr int kSide = 700;  // points along a side; about 21 along that of a voxel
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const double x = double(i) / (kSide - 1), y = double(j) / (kSide - 1);
      capture.cloud.positions.push_back(
          {static_cast<float>(x), static_cast<float>(y), static_cast<float>(0.35 * x + 0.45 * y)});
      const double length = std::sqrt(1 + 0.35 * 0.35 + 0.45 * 0.45);
      capture.cloud.normals.push_back({static_cast<float>(0.35 / length),
                                       static_cast<float>(0.45 / length),
                                       static_cast<float>(-1 / length)});
    }
  capture.cameras = {camera_at(4, 160)};  // 0.025 a pixel
  const std::vector<int> all{0};
  const auto voxels = voxelise_geometry(capture, capture.cloud, all, 0, 0);
  ASSERT_TRUE(voxels) << voxels.error().message;
  ASSERT_FALSE(voxels->density.limited_by_cloud);
  std::set<std::pair<int, int>> columns;
  for (const Voxel& v : voxels->positions) columns.emplace(v[0], v[1]);
  const double cells = 1 / voxels->grid.step;
  const auto side = static_cast<std::size_t>(std::floor(cells + 0.5)) + 1;
  EXPECT_EQ(columns.size(), side * side) << "no hole";
  EXPECT_LE(voxels->positions.size(), side * side * 101 / 100) << "hardly a column has two";
  EXPECT_EQ(voxels->merged + voxels->positions.size(), capture.cloud.positions.size());
  EXPECT_EQ(voxels->normals.size(), voxels->positions.size());
}

TEST(Density, ACloudOfVoxelsStaysWhatItIs) {
  Capture capture;
  for (int j = 0; j < 40; ++j)
    for (int i = 0; i < 40; ++i) {
      const int k = (i + j) / 2;
      capture.cloud.positions.push_back(
          {static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)});
    }
  const auto voxels = voxelise_geometry(capture, capture.cloud, {}, 0, 0);
  ASSERT_TRUE(voxels) << voxels.error().message;
  EXPECT_EQ(voxels->grid.step, 1);
  EXPECT_EQ(voxels->merged, 0u);
}

TEST(Density, GivenNumbersAreKept) {
  const Capture capture = square(50, {camera_at(4, 640)});
  const std::vector<int> all{0};
  EXPECT_EQ(voxelise_geometry(capture, capture.cloud, all, 7, 0)->grid.bits, 7);
  EXPECT_EQ(voxelise_geometry(capture, capture.cloud, all, 0, 0.03)->grid.step, 0.03);
}

TEST(Density, OnePointAndCoincidingPointsAreWhatTheyWere) {
  Capture capture;
  capture.cloud.positions = {{1, 2, 3}};
  ASSERT_TRUE(voxelise_geometry(capture, capture.cloud, {}, 0, 0));
  capture.cloud.positions.push_back({1, 2, 3});
  const auto voxels = voxelise_geometry(capture, capture.cloud, {}, 0, 0);
  ASSERT_FALSE(voxels);
  EXPECT_THAT(voxels.error().message, HasSubstr("one voxel"));
}

}  // namespace
}  // namespace slf::density_test
