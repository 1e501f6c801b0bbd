// SPDX-License-Identifier: Apache-2.0
#include "slf/splat_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "capture/nearest.h"
#include "capture/surface_points.h"
#include "traced_scene.h"

namespace slf::splat_surface_test {
namespace {

/// Flat ones on the exact points, the short axis another one each time.
Gaussians splats_on(const PointCloud& cloud, float deviation) {
  Gaussians splats;
  for (std::size_t p = 0; p < cloud.positions.size(); ++p) {
    Float3 axis{};  // short, turned to the normal by the half turn about what lies between
    axis[p % 3] = 1;
    Float3 between = along(axis, 1, cloud.normals[p]);
    if (dot(between, between) < 1e-3f) between = {axis[1], axis[2], axis[0]};
    const float length = std::sqrt(dot(between, between));
    Float3 deviations{std::log(deviation), std::log(deviation), std::log(deviation)};
    deviations[p % 3] += std::log(0.05f);
    splats.positions.push_back(cloud.positions[p]);
    splats.log_deviations.push_back(deviations);
    splats.rotations.push_back({0, between[0] / length, between[1] / length, between[2] / length});
    splats.logits.push_back(4);
    splats.harmonics.insert(splats.harmonics.end(), 3, 0.0f);
  }
  return splats;
}

TEST(SplatSurface, SplatsOfOthersBecomeTheLayerOfPointsThatTheyShow) {
  const test::TracedScene traced("vase", 3, 8, 192, 4000);
  // Wider ones reach beyond the object's outline, and are seen there.
  const Gaussians splats = splats_on(traced.exact, float(0.75 * traced.step));
  const auto cloud = surface_of_splats(splats, traced.capture, traced.cameras);
  ASSERT_TRUE(cloud) << cloud.error().message;
  EXPECT_EQ(cloud->normals.size(), cloud->positions.size());
  const NearestPoints tree(traced.exact.positions);
  std::size_t near = 0;
  for (const Float3& p : cloud->positions) {
    std::uint32_t nearest = 0;
    tree.nearest(p, 1, &nearest, nullptr);
    const Float3 apart = minus(p, traced.exact.positions[nearest]);
    near += std::abs(dot(apart, traced.exact.normals[nearest])) < traced.step;
  }
  EXPECT_GT(double(near), 0.99 * double(cloud->positions.size()));
  const auto none = surface_of_splats(splats, traced.capture, std::span(traced.cameras).first(2));
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("too few cameras"), std::string::npos);
}

}  // namespace
}  // namespace slf::splat_surface_test
