// SPDX-License-Identifier: Apache-2.0
// Points of the world on pixels, and distortion of the lens.
#include <gtest/gtest.h>

#include "slf/capture.h"

namespace slf::camera_projection_test {
namespace {

TEST(CameraProject, HonoursBrownDistortionAsColmapsOpencvModel) {
  Camera camera;
  camera.fx = 100;
  camera.fy = 200;
  camera.cx = 10;
  camera.cy = 20;
  camera.distortion = {0.1, 0.01, 0.002, 0.003};
  // x = 0.5, y = -1, r^2 = 1.25: radial 0.125 + 0.015625 = 0.140625;
  // dx = 0.0703125 + 2*0.002*-0.5 + 0.003*(1.25 + 0.5)   = 0.0735625
  // dy = -0.140625 + 2*0.003*-0.5 + 0.002*(1.25 + 2)     = -0.137125
  const auto at = camera.project({1, -2, 2});
  ASSERT_TRUE(at);
  EXPECT_NEAR((*at)[0], 100 * 0.5735625 + 10, 1e-12);
  EXPECT_NEAR((*at)[1], 200 * -1.137125 + 20, 1e-12);
}

TEST(CameraProject, ShowsNothingBehindTheCameraOrBeyondTheFoldOfTheDistortion) {
  Camera camera;
  camera.fx = camera.fy = 100;
  double z = 1;
  EXPECT_FALSE(camera.project({0, 0, -1}, &z));
  EXPECT_EQ(z, -1);
  EXPECT_FALSE(camera.project({0, 0, 0}));
  camera.distortion = {-1.0 / 3, 0, 0, 0};  // r - r^3 / 3 turns back at r = 1
  EXPECT_TRUE(camera.project({0.99, 0, 1}));
  EXPECT_FALSE(camera.project({1.01, 0, 1}));
  EXPECT_FALSE(camera.project({1.7, 0, 1}));  // would be folded onto 0.06
  camera.distortion = {-1.0, 1.0, 0, 0};      // 1 - 3 s + 5 s^2 has no root: it never turns back
  EXPECT_TRUE(camera.project({3, 0, 1}));
}

}  // namespace
}  // namespace slf::camera_projection_test
