// SPDX-License-Identifier: Apache-2.0
// What a view of a whole light field has to show.
#include "lightfield/render/framed_ball.h"

#include <gtest/gtest.h>

#include <cmath>

namespace slf::framed_ball_test {
namespace {

const Grid kGrid{{-1, 2, 3}, 0.5, 16};

std::vector<Voxel> cube(int side) {
  std::vector<Voxel> voxels;
  for (int i = 0; i < side * side * side; ++i)
    voxels.push_back({1000 + i % side, 1000 + i / side % side, 1000 + i / (side * side)});
  return voxels;
}

TEST(FramedBall, HoldsEveryPointOfACloud) {
  const FramedBall ball = framed_ball(kGrid, cube(11));
  EXPECT_EQ(ball.centre, (Vec3{501.5, 504.5, 505.5}));
  EXPECT_NEAR(ball.radius, 0.5 * 5 * std::sqrt(3.0), 1e-9);
  EXPECT_EQ(framed_ball(kGrid, {}).radius, 0);
  EXPECT_EQ(framed_ball(kGrid, std::vector<Voxel>{{1, 1, 1}}).radius, 0);
}

TEST(FramedBall, IsNotThatOfAFewPointsFarAway) {
  auto voxels = cube(11);
  const FramedBall object = framed_ball(kGrid, voxels);
  for (const Voxel far : {Voxel{0, 0, 0}, {60000, 0, 0}, {0, 60000, 0}, {9, 9, 50000}})
    voxels.push_back(far);
  const FramedBall ball = framed_ball(kGrid, voxels);
  EXPECT_EQ(ball.centre, object.centre);
  EXPECT_EQ(ball.radius, object.radius);
}

TEST(FramedBall, KeepsAPartThatIsNotFew) {
  auto voxels = cube(11);
  for (const Voxel& v : cube(4)) voxels.push_back({v[0] + 9000, v[1], v[2]});
  EXPECT_GT(framed_ball(kGrid, voxels).radius, 2000);
}

TEST(FramedBall, ATenthOfSplatsMayBeSky) {
  std::vector<std::array<float, 3>> splats;
  for (const Voxel& v : cube(10)) splats.push_back({float(v[0]), float(v[1]), float(v[2])});
  const double object = framed_ball(splats).radius;
  for (int i = 0; i < 100; ++i) splats.push_back({60000, 600.0f * float(i), 0});
  EXPECT_EQ(framed_ball(splats).radius, object);
  for (int i = 0; i < 400; ++i) splats.push_back({60000, 600.0f * float(i), 0});
  EXPECT_GT(framed_ball(splats).radius, 10 * object) << "a third is no sky";
}

}  // namespace
}  // namespace slf::framed_ball_test
