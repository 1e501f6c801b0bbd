// SPDX-License-Identifier: Apache-2.0
#include "encoder/refine/silhouettes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "capture/spacing.h"
#include "sphere_points.h"

namespace slf::silhouettes_test {
namespace {

/// A sphere before plain grey, seen from z = -5, with the disc that its photograph shows.
Capture photographed_sphere() {
  Capture capture;
  Camera camera;
  camera.width = camera.height = 200;
  camera.fx = camera.fy = 400;
  camera.cx = camera.cy = 100;
  camera.translation = {0, 0, 5};
  capture.cameras.push_back(camera);
  Image image{200, 200, 3, {}};
  const double disc = 400 / std::sqrt(24.0);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x)
      for (int c = 0; c < 3; ++c)
        image.data.push_back(std::hypot(x - 99.5, y - 99.5) < disc ? 200 : 100);
  capture.images.push_back(image);
  return capture;
}

class SilhouetteTest : public testing::Test {
 protected:
  SilhouetteTest() {
    silhouettes_ = *load_silhouettes(capture_, std::vector<int>{0}, sphere_, spacing_, 2);
  }
  SurfacePoints of_radius(double radius) const {
    SurfacePoints points = sphere_;
    for (Float3& p : points.positions)
      for (float& x : p) x *= float(radius);
    return points;
  }

  const SurfacePoints sphere_ = sphere(6000);
  const double spacing_ = typical_spacing(sphere_.positions);
  const Capture capture_ = photographed_sphere();
  std::vector<Silhouette> silhouettes_;
};

TEST_F(SilhouetteTest, WhatIsUncoveredCountsAsTheBackgroundThatShowsInItsPlace) {
  SurfacePoints torn;
  for (std::size_t p = 0; p < sphere_.size(); ++p) {
    const Float3& at = sphere_.positions[p];
    if (at[0] * at[0] + at[1] * at[1] < 0.09f) continue;  // through and through
    torn.positions.push_back(at);
    torn.normals.push_back(sphere_.normals[p]);
    torn.source.push_back(std::uint32_t(p));
  }
  const HeldOutErrors errors = uncovered_errors(silhouettes_, sphere_, torn, spacing_, 2);
  EXPECT_NEAR(errors.mean(), 100 * 100, 1);
  std::size_t counted = 0;
  for (std::size_t p = 0; p < sphere_.size(); ++p)
    if (errors.views[p] > 0) {
      ++counted;
      EXPECT_LT(std::hypot(sphere_.positions[p][0], sphere_.positions[p][1]), 0.3);
      EXPECT_LT(sphere_.positions[p][2], 0);  // the side that the camera sees
    }
  EXPECT_GT(counted, 50u);
}

TEST_F(SilhouetteTest, AnObjectAsGreyAsItsBackgroundCountsWhereThatIsAsked) {
  Capture capture = capture_;
  for (std::uint8_t& value : capture.images[0].data) value = value == 200 ? 110 : value;
  const auto alike = *load_silhouettes(capture, std::vector<int>{0}, sphere_, spacing_, 2);
  const SurfacePoints smaller = of_radius(1 - 5 * spacing_);
  EXPECT_EQ(uncovered_errors(alike, sphere_, smaller, spacing_, 2).mean(), 0);
  EXPECT_NEAR(uncovered_errors(alike, sphere_, smaller, spacing_, 2, 64).mean(), 64 * 64, 1);
}

TEST_F(SilhouetteTest, ASmallerOutlineUncoversNothingUntilItIsAPointSpacingSmaller) {
  EXPECT_EQ(uncovered_errors(silhouettes_, sphere_, of_radius(1 - spacing_), spacing_, 2).mean(),
            0);
  EXPECT_GT(
      uncovered_errors(silhouettes_, sphere_, of_radius(1 - 5 * spacing_), spacing_, 2).mean(), 0);
}

TEST_F(SilhouetteTest, OutlinesGoWhereThePhotographHasThem) {
  const double pixel = std::sqrt(24.0) / 400;  // at the outline
  const double slack = 3.5 * pixel;            // 2 that are granted, and what steps and discs add
  for (const double radius : {1.0, 1.08}) {
    const SurfacePoints points = of_radius(radius);
    const auto limits = outline_limits(silhouettes_, points, spacing_, 2);
    std::size_t limited = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (limits[p].most > 1) continue;
      ++limited;
      EXPECT_LE(limits[p].least, limits[p].most);
      EXPECT_GE(limits[p].least, 1 - radius - slack);
      EXPECT_LE(limits[p].most, 1 - radius + spacing_ + slack);
      // Seen from a finite distance the outline is a little before the middle.
      EXPECT_NEAR(points.positions[p][2] / radius, -0.2, 0.25);
    }
    EXPECT_GT(limited, 100u) << radius;
    EXPECT_LT(limited, 2500u) << radius;
  }
}

TEST_F(SilhouetteTest, BeforeAMotleyBackgroundNothingIsSaid) {
  Capture capture = capture_;
  for (std::size_t i = 0; i < capture.images[0].data.size(); ++i)
    if (capture.images[0].data[i] == 100) capture.images[0].data[i] = std::uint8_t(i * 37);
  const auto motley = load_silhouettes(capture, std::vector<int>{0}, sphere_, spacing_, 2);
  ASSERT_TRUE(motley);
  for (const OffsetLimits& limits : outline_limits(*motley, sphere_, spacing_, 2))
    EXPECT_GT(limits.most, 1e30f);
  EXPECT_EQ(uncovered_errors(*motley, sphere_, of_radius(0.5), spacing_, 2).mean(), 0);
}

}  // namespace
}  // namespace slf::silhouettes_test
