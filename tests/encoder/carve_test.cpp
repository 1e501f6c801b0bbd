// SPDX-License-Identifier: Apache-2.0
#include "encoder/refine/carve.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "sphere_points.h"

namespace slf::carve_test {
namespace {

constexpr int kSide = 200;
constexpr double kFocal = 400, kAway = 5;
const double kDisc = kFocal / std::sqrt(kAway * kAway - 1);  // pixels: of a sphere of radius 1
const double kPixel = kAway / kFocal;                        // at the sphere

/// Looks at the origin from `kAway` along an axis in the plane z = 0, x to the right of it.
Camera camera_at(double turn) {
  Camera camera;
  camera.width = camera.height = kSide;
  camera.fx = camera.fy = kFocal;
  camera.cx = camera.cy = kSide / 2.0;
  const double c = std::cos(turn), s = std::sin(turn);
  camera.rotation = {{{{c, s, 0}}, {{0, 0, 1}}, {{s, -c, 0}}}};
  camera.translation = {0, 0, kAway};
  return camera;
}

class CarveTest : public testing::Test {
 protected:
  CarveTest() {
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      cameras_[i] = camera_at(std::numbers::pi * double(i) / double(cameras_.size()));
      Outline outline{&cameras_[i], {}};
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
          outline.object.push_back(std::hypot(x + 0.5 - kSide / 2.0, y + 0.5 - kSide / 2.0) <
                                   kDisc);
      outlines_.push_back(outline);
    }
  }
  std::array<Camera, 24> cameras_;
  std::vector<Outline> outlines_;
};

TEST_F(CarveTest, AFatCloudIsBroughtToItsOutlinesAndAThinOneStays) {
  // Two outlines, 15 degrees, may be missed: 0.035; pixels; and what the ring sees from beside.
  constexpr double kNear = 0.08;
  for (const double scale : {1.15, 0.9}) {
    SurfacePoints points = sphere(3000);
    for (Float3& p : points.positions)
      for (float& x : p) x *= float(scale);
    const SurfacePoints before = points;
    carve(points, outlines_, 0.5 * kPixel, 0.5, 2);
    ASSERT_EQ(points.size(), before.size());
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (scale < 1) {
        EXPECT_EQ(points.positions[p], before.positions[p]);
      } else if (std::abs(before.normals[p][2]) < 0.25) {  // seen as outlines by the ring
        EXPECT_NEAR(radius(points.positions[p]), 1, kNear);
      }
      EXPECT_LE(radius(points.positions[p]), radius(before.positions[p]) + 1e-6);
    }
  }
}

TEST_F(CarveTest, WhatNoShortWayLeadsInsideIsLeftOut) {
  SurfacePoints points = sphere(1000);
  points.positions[7] = {1.9f, 0, 0};
  points.normals[7] = {-1, 0, 0};  // inwards is farther away
  carve(points, outlines_, 0.5 * kPixel, 0.5, 2);
  ASSERT_EQ(points.size(), 999u);
  EXPECT_EQ(points.source[7], 8u);
}

TEST_F(CarveTest, WithoutOutlinesNothingMoves) {
  SurfacePoints points = sphere(100);
  points.positions[7] = {9, 9, 9};
  const auto before = points.positions;
  carve(points, {}, 0.5 * kPixel, 0.5, 2);
  EXPECT_EQ(points.positions, before);
}

TEST_F(CarveTest, AnyNumberOfThreadsGivesTheSame) {
  SurfacePoints one = sphere(3000);
  for (Float3& p : one.positions)
    for (float& x : p) x *= 1.1f;
  SurfacePoints three = one;
  carve(one, outlines_, 0.5 * kPixel, 0.5, 1);
  carve(three, outlines_, 0.5 * kPixel, 0.5, 3);
  EXPECT_EQ(one.positions, three.positions);
  EXPECT_EQ(one.source, three.source);
}

}  // namespace
}  // namespace slf::carve_test
