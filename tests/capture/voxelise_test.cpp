// SPDX-License-Identifier: Apache-2.0
// Clouds onto the grid, Morton order, nearest points, normals.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "capture/nearest.h"
#include "capture_support.h"
#include "geometry/morton.h"

namespace slf::voxelise_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

PointCloud cloud_of(std::vector<std::array<float, 3>> positions) {
  PointCloud cloud;
  cloud.positions = std::move(positions);
  return cloud;
}

TEST(Morton, PutsBitIOfXYZAtThreeIAndOneAndTwo) {
  EXPECT_EQ(morton({1, 0, 0}), 1u);
  EXPECT_EQ(morton({0, 1, 0}), 2u);
  EXPECT_EQ(morton({0, 0, 1}), 4u);
  EXPECT_EQ(morton({5, 2, 3}), 1u | 4u | 16u | 32u | 64u);  // x 101, y 010, z 011
  const Voxel last{(1 << 21) - 1, 0, (1 << 21) - 1};
  EXPECT_EQ(from_morton(morton(last)), last);
  EXPECT_EQ(morton({(1 << 21) - 1, (1 << 21) - 1, (1 << 21) - 1}), (std::uint64_t{1} << 63) - 1);
}

TEST(Voxelise, TakesTheNearestVoxelOfAGridThatSpansTheLargestExtent) {
  // Extent 14 at 3 bits: step 2. y = 1 lies half way and rounds up.
  const auto voxels = voxelise(cloud_of({{13, 1, 2}, {-1, 0, 2}, {2.9f, 0.99f, 2.5f}}), 3);
  ASSERT_TRUE(voxels) << voxels.error().message;
  EXPECT_EQ(voxels->grid.bits, 3);
  EXPECT_EQ(voxels->grid.step, 2.0);
  EXPECT_EQ(voxels->grid.origin, (Vec3{-1, 0, 2}));
  EXPECT_THAT(voxels->positions, ElementsAre(Voxel{0, 0, 0}, Voxel{2, 0, 0}, Voxel{7, 1, 0}));
  EXPECT_EQ(voxels->merged, 0u);
}

TEST(Voxelise, OrdersByMortonWithXLeastSignificant) {
  const auto voxels = voxelise(
      cloud_of({{1, 1, 1}, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, 0}, {3, 0, 0}, {0, 3, 0}}), 2);
  ASSERT_TRUE(voxels);
  EXPECT_THAT(voxels->positions,
              ElementsAre(Voxel{0, 0, 0}, Voxel{1, 0, 0}, Voxel{0, 1, 0}, Voxel{0, 0, 1},
                          Voxel{1, 1, 1}, Voxel{3, 0, 0}, Voxel{0, 3, 0}));
}

TEST(Voxelise, MergedPointsGetMeanColourAndRenormalisedMeanNormal) {
  PointCloud cloud = cloud_of({{0, 0, 0}, {10, 0, 0}, {0.1f, 0, 0}, {10, 0.1f, 0}});
  cloud.normals = {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 0, -1}};
  cloud.colours = {{0, 10, 255}, {7, 7, 7}, {1, 20, 255}, {7, 7, 7}};
  const auto voxels = voxelise(cloud, 1);
  ASSERT_TRUE(voxels);
  ASSERT_THAT(voxels->positions, ElementsAre(Voxel{0, 0, 0}, Voxel{1, 0, 0}));
  EXPECT_EQ(voxels->merged, 2u);
  EXPECT_EQ(voxels->colours[0], (std::array<float, 3>{0.5f, 15, 255}));
  EXPECT_FLOAT_EQ(voxels->normals[0][0], std::sqrt(0.5f));
  EXPECT_FLOAT_EQ(voxels->normals[0][1], std::sqrt(0.5f));
  EXPECT_EQ(voxels->normals[1], (std::array<float, 3>{0, 0, 1}));  // they cancel: the first
}

TEST(Voxelise, AVoxelSizeChoosesTheBitsItTakes) {
  const auto cloud = cloud_of({{0, 0, 0}, {4, 0, 0}});
  for (const auto& [size, bits] : {std::pair{4.0, 1}, {1.0, 3}, {4.0 / 7, 3}, {0.5, 4}, {4.0, 1}}) {
    const auto voxels = voxelise(cloud, 99, size);
    ASSERT_TRUE(voxels) << size;
    EXPECT_EQ(voxels->grid.bits, bits) << size;
    EXPECT_EQ(voxels->grid.step, size);
  }
  EXPECT_TRUE(voxelise(cloud, 0, 4.0 / ((1 << 21) - 1)));
  const auto small = voxelise(cloud, 0, 4.0 / (1 << 21));
  ASSERT_FALSE(small);
  EXPECT_EQ(small.error().code, Errc::kInvalidInput);
  EXPECT_THAT(small.error().message, HasSubstr("more than 21 bits"));
}

TEST(Voxelise, TheLargestCoordinateFitsAtEveryDepth) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(-1e3f, 1e3f);
  for (int bits = 1; bits <= 21; ++bits) {
    PointCloud cloud;
    for (int i = 0; i < 50; ++i)
      cloud.positions.push_back({uniform(random), uniform(random), uniform(random)});
    const auto voxels = voxelise(cloud, bits);
    ASSERT_TRUE(voxels);
    int largest = 0;
    for (const auto& v : voxels->positions)
      for (const int x : v) {
        ASSERT_GE(x, 0);
        largest = std::max(largest, x);
      }
    EXPECT_EQ(largest, (1 << bits) - 1);
    EXPECT_TRUE(
        std::is_sorted(voxels->positions.begin(), voxels->positions.end(),
                       [](const Voxel& a, const Voxel& b) { return morton(a) < morton(b); }));
  }
}

TEST(Voxelise, UnusableCloudsAndSettingsAreRefused) {
  const auto code = [](const PointCloud& cloud, int bits, double size = 0) {
    const auto voxels = voxelise(cloud, bits, size);
    return voxels ? "accepted" : to_string(voxels.error().code) + (": " + voxels.error().message);
  };
  const auto two = cloud_of({{0, 0, 0}, {1, 1, 1}});
  EXPECT_THAT(code({}, 8), HasSubstr("kInvalidInput: point cloud: no points"));
  EXPECT_THAT(code(cloud_of({{0, 0, 0}, {0, std::nanf(""), 0}}), 8), HasSubstr("point 1 has"));
  EXPECT_THAT(code(cloud_of({{0, 0, 0}, {0, 0, INFINITY}}), 8), HasSubstr("kInvalidInput"));
  EXPECT_THAT(code(cloud_of({{1, 2, 3}, {1, 2, 3}}), 8), HasSubstr("in one voxel"));
  EXPECT_THAT(code(two, 8, 100), HasSubstr("in one voxel"));
  EXPECT_THAT(code(two, 0), HasSubstr("kInvalidArgument"));
  EXPECT_THAT(code(two, 22), HasSubstr("kInvalidArgument"));
  EXPECT_THAT(code(two, 8, -1), HasSubstr("kInvalidArgument"));
  EXPECT_THAT(code(two, 8, std::nan("")), HasSubstr("kInvalidArgument"));
  EXPECT_EQ(code(cloud_of({{1, 2, 3}}), 8), "accepted");  // one point is one voxel
}

// Counted with numpy by the same formula. (At 8 bits the shared cloud blender_can_8 has 91,753: it
// was made with another one, floor((x - min) / extent * 2^bits).)
TEST(Voxelise, TheCanHasAsManyVoxelsAsAnotherProgramCounts) {
  const auto file = test::shared_data() / "blender_can" / "points.ply";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared captures";
  const auto cloud = read_ply(file);
  ASSERT_TRUE(cloud) << cloud.error().message;
  EXPECT_EQ(cloud->positions.size(), 91791u);
  const auto voxels8 = voxelise(*cloud, 8), voxels9 = voxelise(*cloud, 9);
  ASSERT_TRUE(voxels8 && voxels9);
  EXPECT_EQ(voxels8->positions.size(), 91571u);
  EXPECT_EQ(voxels9->positions.size(), 91791u);
}

// Against a plain sort by (distance, index), on a lattice, where most distances are tied.
TEST(NearestPoints, TiesGoByIndexWhateverTheTreeVisitsFirst) {
  std::vector<std::array<float, 3>> points;
  for (int i = 0; i < 343; ++i) {
    const int x = i % 7, y = i / 7 % 7, z = i / 49;
    points.push_back({float(x), float(y), float(z)});
  }
  std::mt19937 random(3);
  std::shuffle(points.begin(), points.end(), random);
  points.push_back(points[5]);  // a duplicate
  const NearestPoints tree(points);
  for (const int k : {1, 7, 64, 100}) {
    for (std::size_t q = 0; q < points.size(); q += 11) {
      std::vector<std::pair<float, std::uint32_t>> expected;
      for (std::uint32_t i = 0; i < points.size(); ++i) {
        float squared = 0;
        for (std::size_t a = 0; a < 3; ++a)
          squared += (points[i][a] - points[q][a]) * (points[i][a] - points[q][a]);
        expected.emplace_back(squared, i);
      }
      std::sort(expected.begin(), expected.end());
      std::vector<std::uint32_t> indices(static_cast<std::size_t>(k));
      std::vector<float> squared(static_cast<std::size_t>(k));
      tree.nearest(points[q], k, indices.data(), squared.data());
      for (std::size_t i = 0; i < indices.size(); ++i) {
        ASSERT_EQ(indices[i], expected[i].second)
            << "query " << q << ", k " << k << ", place " << i;
        ASSERT_EQ(squared[i], expected[i].first);
      }
    }
  }
}

std::vector<std::array<float, 3>> sphere_points(int count) {  // golden spiral
  std::vector<std::array<float, 3>> points;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z), a = 2.399963229728653 * i;
    points.push_back({float(r * std::cos(a)), float(r * std::sin(a)), float(z)});
  }
  return points;
}

double worst_cosine(const std::vector<std::array<float, 3>>& normals,
                    const std::vector<std::array<float, 3>>& expected) {
  double worst = 1;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    double dot = 0;
    for (std::size_t k = 0; k < 3; ++k) dot += double(normals[i][k]) * double(expected[i][k]);
    worst = std::min(worst, dot);
  }
  return worst;
}

TEST(Normals, NormalsOfASpherePointOutwardsFromAnyDistanceOfTheCameras) {
  const auto cloud = cloud_of(sphere_points(4000));
  // The neighbourhood of 16 points spans 0.06 rad; its plane is off by far less than that: 0.998.
  EXPECT_GT(worst_cosine(estimate_normals(cloud, {}), cloud.positions), 0.998);
  for (const double distance : {1.5, 3.0, 20.0}) {
    std::vector<Vec3> cameras;
    for (const auto& p : sphere_points(30))
      cameras.push_back(
          {distance * double(p[0]), distance * double(p[1]), distance * double(p[2])});
    EXPECT_GT(worst_cosine(estimate_normals(cloud, cameras), cloud.positions), 0.998) << distance;
  }
}

TEST(Normals, NormalsOfARoomPointInwardsToTheCamerasInIt) {
  const auto cloud = cloud_of(sphere_points(4000));
  auto inwards = cloud.positions;
  for (auto& p : inwards)
    for (float& x : p) x = -x;
  const std::vector<Vec3> cameras{{0.1, 0, 0}, {0, -0.2, 0.1}};
  EXPECT_GT(worst_cosine(estimate_normals(cloud, cameras), inwards), 0.998);
}

TEST(Normals, AreTheSameForAnyThreadCountAndForDegenerateClouds) {
  const auto cloud = cloud_of(sphere_points(3000));
  const std::vector<Vec3> cameras{{3, 0, 0}, {0, 3, 1}};
  const auto one = estimate_normals(cloud, cameras, 16, 1);
  EXPECT_EQ(one, estimate_normals(cloud, cameras, 16, 2));
  EXPECT_EQ(one, estimate_normals(cloud, cameras, 16, 7));
  for (const auto& positions : {std::vector<std::array<float, 3>>{},
                                {{1, 2, 3}},
                                {{1, 2, 3}, {1, 2, 3}},
                                {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}})
    for (const auto& normal : estimate_normals(cloud_of(positions), cameras))
      EXPECT_NEAR(std::hypot(normal[0], normal[1], normal[2]), 1, 1e-6);
}

TEST(Normals, NormalsBeyondFloatsAreOrientedWithoutConversionsThatOverflow) {
  std::vector<std::array<float, 3>> positions;
  for (int i = 0; i < 100; ++i)
    positions.push_back({3e38f * static_cast<float>(std::cos(i)),
                         -3e38f * static_cast<float>(std::sin(i)),
                         1e38f * static_cast<float>(i % 3)});
  EXPECT_EQ(estimate_normals(cloud_of(positions), {{0, 0, 1e39}, {-1e308, 0, 0}}).size(), 100u);
}

}  // namespace
}  // namespace slf::voxelise_test
