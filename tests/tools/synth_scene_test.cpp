// SPDX-License-Identifier: Apache-2.0
// Where cameras stand, and the surfaces they see.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "slf/capture.h"
#include "tools/synth/rings.h"
#include "tools/synth/sample_points.h"
#include "tools/synth/scene.h"
#include "tools/synth/trace.h"

namespace slf::synth::synth_scene_test {
namespace {

TEST(RingsTest, SplitsAreThePapersAndEvaluationIsHeldOutOfAllOfThem) {
  const Rings rings = make_rings(11, 50, 256, 256, 0.9);
  EXPECT_EQ(rings.splits.at("dense").size(), 125u);
  EXPECT_EQ(rings.splits.at("intermediate").size(), 39u);
  EXPECT_EQ(rings.splits.at("sparse").size(), 14u);
  EXPECT_EQ(rings.splits.at("evaluation").size(), 100u);
  std::set<int> input;
  for (const char* split : {"dense", "intermediate", "sparse"})
    input.insert(rings.splits.at(split).begin(), rings.splits.at(split).end());
  for (const int camera : rings.splits.at("evaluation")) EXPECT_EQ(input.count(camera), 0u);
  for (const int camera : rings.splits.at("dense")) {
    EXPECT_EQ(rings.circle[std::size_t(camera)] % 2, 1);
    EXPECT_EQ(rings.index[std::size_t(camera)] % 2, 0);
  }
  // Every camera is in some split, and numbered after its place.
  EXPECT_EQ(rings.cameras.size(), input.size() + 100);
  for (std::size_t i = 0; i < rings.cameras.size(); ++i) {
    const std::string number = std::to_string(10000 + 50 * rings.circle[i] + rings.index[i] + 1);
    EXPECT_EQ(rings.cameras[i].name, "images/" + number.substr(1) + ".png");
  }
}

TEST(RingsTest, CamerasLieOnTheSphereAndLookAtTheOriginUpright) {
  const Rings rings = make_rings(11, 50, 320, 240, 0.9);
  for (std::size_t i = 0; i < rings.cameras.size(); ++i) {
    const Camera& camera = rings.cameras[i];
    const Vec3 centre = camera.centre();
    EXPECT_NEAR(length(centre), 5, 1e-12);
    EXPECT_NEAR(centre[2], 5 * (-0.85 + 0.17 * rings.circle[i]), 1e-12);
    const auto middle = camera.project({0, 0, 0});
    ASSERT_TRUE(middle);
    EXPECT_NEAR((*middle)[0], 160, 1e-9);
    EXPECT_NEAR((*middle)[1], 120, 1e-9);
    const auto above = camera.project({0, 0, 0.1});  // image y points down
    EXPECT_LT((*above)[1], 120);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(dot(camera.rotation[std::size_t(k)], camera.rotation[std::size_t((k + 1) % 3)]),
                  0, 1e-12);
    EXPECT_NEAR(dot(cross(camera.rotation[0], camera.rotation[1]), camera.rotation[2]), 1, 1e-12);
  }
}

class SceneTest : public testing::TestWithParam<const char*> {};

TEST_P(SceneTest, NormalsAreUnitPerpendicularToTheSurfaceAndOutward) {
  const auto scene = make_scene(GetParam());
  const PointCloud cloud = sample_points(*scene, 3000, 2);
  ASSERT_GT(cloud.positions.size(), 2000u);
  ASSERT_LT(cloud.positions.size(), 4500u);
  int inside_out = 0;
  for (std::size_t p = 0; p < cloud.positions.size(); ++p) {
    const auto& at = cloud.positions[p];
    const auto& m = cloud.normals[p];
    const Vec3 position{at[0], at[1], at[2]}, n{m[0], m[1], m[2]};
    ASSERT_NEAR(length(n), 1, 1e-5);
    // A ray from far outside along -n enters here: as many crossings lie before as leave the body.
    const Ray ray{position + 10 * n, -1 * n};
    std::vector<SurfacePoint> crossings;
    scene->crossings(ray, crossings);
    int before = 0;
    for (const auto& c : crossings) before += dot(c.position - ray.origin, ray.direction) < 9.99;
    inside_out += before % 2;
  }
  // A crossing within 0.01 of the point counts wrongly at thin rims.
  EXPECT_LT(inside_out, static_cast<int>(cloud.positions.size() / 50));
}

TEST_P(SceneTest, TheCloudIsTheSameForAnyThreadCountAndLiesWithinBounds) {
  const auto scene = make_scene(GetParam());
  const PointCloud one = sample_points(*scene, 3000, 1), seven = sample_points(*scene, 3000, 7);
  EXPECT_EQ(one.positions, seven.positions);
  EXPECT_EQ(one.normals, seven.normals);
  EXPECT_EQ(one.colours, seven.colours);
  for (const auto& p : one.positions)
    ASSERT_LE(length({p[0], p[1], p[2]}), scene->bounds().radius + 1e-6);
}

TEST_P(SceneTest, PhotographsShowThePointsOfTheCloudInFrontOfGrey128) {
  const auto scene = make_scene(GetParam());
  const Camera camera = make_rings(3, 4, 64, 64, scene->bounds().radius).cameras[5];
  const Image image = trace_image(*scene, camera, 2);
  const PointCloud cloud = sample_points(*scene, 20000, 2);
  std::vector<bool> shown(64 * 64);
  for (const auto& p : cloud.positions) {
    const auto at = camera.project({p[0], p[1], p[2]});
    ASSERT_TRUE(at);
    ASSERT_TRUE((*at)[0] > 0 && (*at)[0] < 64 && (*at)[1] > 0 && (*at)[1] < 64);
    shown[std::size_t((*at)[1]) * 64 + std::size_t((*at)[0])] = true;
  }
  int object = 0, background = 0, wrong = 0;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const bool grey =
        image.data[3 * i] == 128 && image.data[3 * i + 1] == 128 && image.data[3 * i + 2] == 128;
    object += shown[i];
    background += !shown[i];
    wrong += grey == shown[i];
  }
  EXPECT_GT(object, 400);
  EXPECT_GT(background, 400);
  EXPECT_LT(wrong, 60);  // pixels of the outline that only a sample or only a point touches
}

INSTANTIATE_TEST_SUITE_P(Scenes, SceneTest, testing::Values("can", "die", "vase"),
                         [](const auto& scene) { return std::string(scene.param); });

TEST(SamplePointsTest, TheDefaultCanIsClosedOnAnEightBitGridWithHardlyAnyDuplicates) {
  const auto scene = make_scene("can");
  const PointCloud cloud = sample_points(*scene, 0, 2);
  EXPECT_GT(cloud.positions.size(), 80000u);
  EXPECT_LT(cloud.positions.size(), 100000u);
  const auto voxels = voxelise(cloud, 8);
  ASSERT_TRUE(voxels);
  EXPECT_LT(voxels->merged, cloud.positions.size() / 100);
  // Closed: what is reached from a corner through faces of empty voxels does not reach the middle.
  std::vector<std::uint8_t> state(256 * 256 * 256);
  const auto at = [](int x, int y, int z) { return std::size_t((z * 256 + y) * 256 + x); };
  for (const Voxel& v : voxels->positions) state[at(v[0], v[1], v[2])] = 1;
  // The can fills the middle of no face of the grid but its own extent in x and y.
  std::vector<std::array<int, 3>> open{{255, 255, 255}};
  state[at(255, 255, 255)] = 2;
  while (!open.empty()) {
    const auto [x, y, z] = open.back();
    open.pop_back();
    for (const auto& d :
         {Voxel{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
      const int nx = x + d[0], ny = y + d[1], nz = z + d[2];
      if (nx < 0 || ny < 0 || nz < 0 || nx > 255 || ny > 255 || nz > 255) continue;
      if (state[at(nx, ny, nz)] != 0) continue;
      state[at(nx, ny, nz)] = 2;
      open.push_back({nx, ny, nz});
    }
  }
  const auto middle = voxels->grid;
  const auto index = [&](std::size_t k) {
    return int(std::lround(-middle.origin[k] / middle.step));
  };
  EXPECT_EQ(state[at(index(0), index(1), index(2))], 0);
}

}  // namespace
}  // namespace slf::synth::synth_scene_test
