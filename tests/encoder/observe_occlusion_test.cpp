// SPDX-License-Identifier: Apache-2.0
// What hides a point: nearer points, as splats, and triangles.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "observe_support.h"

namespace slf::observe_occlusion_test {
namespace {

using namespace test;

TEST(Observe, AnOccluderHidesWhatIsDeeperThanTheTolerance) {
  ObserveSettings settings;  // 2.5 spacings; the spacing is 0.1, a pixel at depth 2 is 0.2 wide
  const Points occluder{{0, 0, 2}};
  EXPECT_TRUE(sees({0, 0, 2}, occluder, settings));
  EXPECT_TRUE(sees({0, 0, 2.3f}, occluder, settings));
  EXPECT_FALSE(sees({0, 0, 3}, occluder, settings));
  EXPECT_TRUE(sees({0, 0, 1.5f}, occluder, settings));     // in front
  EXPECT_TRUE(sees(at(6.5, 4.5, 3), occluder, settings));  // beside
}

TEST(Observe, ASlantedSurfaceDoesNotHideItself) {
  // Seen at 70 degrees: depth changes by 2.7 spacings from point to point.
  const double slope = std::tan(70 * std::numbers::pi / 180);
  Points surface;
  for (int i = -30; i <= 30; ++i)
    for (int j = -8; j <= 8; ++j)
      surface.push_back({static_cast<float>(0.02 * i), static_cast<float>(0.02 * j),
                         static_cast<float>(4 + 0.02 * i * slope)});
  const double a = 70 * std::numbers::pi / 180;
  const std::array<float, 3> normal{static_cast<float>(std::sin(a)), 0,
                                    static_cast<float>(-std::cos(a))};
  const ObservedPoints points{surface, Points(surface.size(), normal)};
  EXPECT_EQ(see(points, surface, {}, ramp(), 0.02).size(), surface.size());
  ObserveSettings strict;
  strict.depth_tolerance = 0;
  EXPECT_LT(see(points, surface, strict, ramp(), 0.02).size(), surface.size() / 2);
}

TEST(Observe, SplatsLeaveNoHolesInASurfaceSparserThanThePixels) {
  // Points every 2.5 pixels; a surface behind them must not be seen through the gaps.
  Points front, behind;
  for (float x = -10; x <= 10; x += 0.5f)
    for (float y = -10; y <= 10; y += 0.5f) front.push_back({x, y, 20});
  for (double u = 0.05; u < 8; u += 0.31)
    for (double v = 0.05; v < 6; v += 0.31) behind.push_back(at(u, v, 40));
  const Points normals(behind.size(), kTowards);
  ObserveSettings fine;
  fine.occlusion_resolution = 8;
  EXPECT_TRUE(see({behind, normals}, front, fine, ramp(), 0.5).empty());
}

TEST(Observe, WithoutToleranceTheNearestPointOfAPixelWins) {
  ObserveSettings strict;
  strict.depth_tolerance = 0;
  const Points pair{at(2.2, 2.2, 2), at(2.8, 2.8, 2.001)};  // one pixel
  const auto seen = see({pair, {kTowards, kTowards}}, pair, strict);
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(seen[0].point, 0u);
  const Points apart{at(2.2, 2.2, 2), at(3.2, 2.8, 2.001)};
  EXPECT_EQ(see({apart, {kTowards, kTowards}}, apart, strict).size(), 2u);
}

/// What the camera sees of points behind a triangle.
bool sees_behind(const Mesh& mesh, const std::array<float, 3>& point) {
  const ObservedPoints points{{point}, {kTowards}};
  const ObserveSettings settings;
  const DepthBuffer depth(small_camera(), mesh,
                          {settings.occlusion_resolution, 0.1, settings.depth_tolerance});
  return !CameraObserver(points, settings).observe(small_camera(), ramp(), depth).sightings.empty();
}

TEST(Observe, ATriangleHidesWhatIsBehindItAndNothingBesideIt) {
  Mesh mesh;
  mesh.vertices.positions = {at(1, 1, 2), at(5, 1, 2), at(1, 5, 4)};  // slanted
  for (const auto& triangle : {std::array<std::uint32_t, 3>{0, 1, 2}, {2, 1, 0}}) {
    mesh.triangles = {triangle};
    EXPECT_FALSE(sees_behind(mesh, at(1.5, 1.5, 5)));
    EXPECT_FALSE(sees_behind(mesh, at(3.4, 1.5, 5)));
    EXPECT_TRUE(sees_behind(mesh, at(5.5, 1.5, 5)));
    EXPECT_TRUE(sees_behind(mesh, at(3.5, 3.5, 5)));
    EXPECT_TRUE(sees_behind(mesh, at(1.5, 1.5, 2.3))) << "within the tolerance";
    EXPECT_TRUE(sees_behind(mesh, at(1.5, 1.5, 1.5)));
  }
}

TEST(Observe, ATriangleThatReachesBehindTheCameraHidesWithItsPartInFront) {
  Mesh mesh;  // a floor below the camera
  mesh.vertices.positions = {{-90, 1, -9}, {90, 1, -9}, {0, 1, 300}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_FALSE(sees_behind(mesh, at(4.5, 5.5, 30)));
  EXPECT_TRUE(sees_behind(mesh, at(4.5, 5.5, 3)));   // above the floor
  EXPECT_TRUE(sees_behind(mesh, at(4.5, 0.5, 30)));  // above the horizon
}

TEST(Observe, TrianglesBehindTheCameraOrWithoutAreaHideNothing) {
  Mesh mesh;
  mesh.vertices.positions = {{-9, -9, -2}, {9, -9, -2}, {0, 9, -2}, at(1, 1, 2), at(3, 3, 2)};
  mesh.triangles = {{0, 1, 2}, {3, 4, 4}, {3, 3, 3}};
  EXPECT_TRUE(sees_behind(mesh, at(2.5, 2.5, 5)));
}

}  // namespace
}  // namespace slf::observe_occlusion_test
