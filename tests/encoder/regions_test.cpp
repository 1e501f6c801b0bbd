// SPDX-License-Identifier: Apache-2.0
#include "encoder/refine/regions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "capture/spacing.h"
#include "encoder/refine/shine_through.h"
#include "sphere_points.h"

namespace slf::regions_test {
namespace {

TEST(RegionsTest, PointsStayWhereErrorsGrowAndMoveWhereTheyFall) {
  const SurfacePoints before = sphere(3000);
  SurfacePoints after = before;
  move_along_normals(after, std::vector<float>(after.size(), -0.05f));
  HeldOutErrors old_errors{std::vector<float>(3000, 10), std::vector<float>(3000, 1), {}};
  HeldOutErrors new_errors = old_errors;
  for (std::size_t p = 0; p < 3000; ++p)
    new_errors.squares[p] = before.positions[p][2] > 0 ? 5.0f : 20.0f;
  const HeldOutErrors none{std::vector<float>(3000, 0), std::vector<float>(3000, 0), {}};
  const auto worse = worse_after(before, old_errors, after, new_errors, none, 0.1);
  const SurfacePoints both = with_kept(before, after, worse);
  ASSERT_EQ(both.size(), 3000u);
  for (const Float3& p : both.positions) {
    if (p[2] > 0.25f) {
      EXPECT_NEAR(radius(p), 0.95, 1e-4);
    }
    if (p[2] < -0.25f) {
      EXPECT_NEAR(radius(p), 1, 1e-4);
    }
  }
}

TEST(RegionsTest, MovedPointsThatNoCameraSeesAreDroppedAndOthersStay) {
  const SurfacePoints before = sphere(1000);
  SurfacePoints after = before;
  std::vector<float> inwards(1000, 0);
  std::fill(inwards.begin(), inwards.begin() + 500, -0.2f);
  move_along_normals(after, inwards);
  std::vector<std::uint8_t> seen(1000, 1);
  std::fill(seen.begin(), seen.begin() + 100, 0);  // moved
  std::fill(seen.begin() + 900, seen.end(), 0);    // not moved
  const SurfacePoints left = without_unsupported(before, after, seen, 0.1);
  ASSERT_EQ(left.size(), 900u);
  EXPECT_EQ(left.source.front(), 100u);
  EXPECT_EQ(left.source.back(), 999u);
}

TEST(ShineThroughTest, AHoleInTheObjectIsFoundAndASmallerOutlineIsNot) {
  const SurfacePoints before = sphere(6000);
  Capture capture;
  Camera camera;  // looks along +z from z = -5
  camera.width = camera.height = 200;
  camera.fx = camera.fy = 400;
  camera.cx = camera.cy = 100;
  camera.translation = {0, 0, 5};
  capture.cameras.push_back(camera);
  SurfacePoints smaller = before, torn;
  for (Float3& p : smaller.positions)
    for (float& x : p) x *= 0.97f;
  for (std::size_t p = 0; p < before.size(); ++p) {
    const Float3& at = before.positions[p];
    if (at[0] * at[0] + at[1] * at[1] < 0.05f) continue;  // through and through
    torn.positions.push_back(at);
    torn.normals.push_back(before.normals[p]);
    torn.source.push_back(std::uint32_t(p));
  }
  const double spacing = typical_spacing(before.positions);
  const auto none = shines_through(capture, std::vector<int>{0}, before, smaller, spacing, 2);
  EXPECT_EQ(std::count(none.begin(), none.end(), 1), 0);
  const auto hole = shines_through(capture, std::vector<int>{0}, before, torn, spacing, 2);
  EXPECT_GT(std::count(hole.begin(), hole.end(), 1), 20);
  for (std::size_t p = 0; p < before.size(); ++p)
    if (hole[p] != 0) {
      EXPECT_LT(std::hypot(before.positions[p][0], before.positions[p][1]), 0.6);
    }
}

}  // namespace
}  // namespace slf::regions_test
