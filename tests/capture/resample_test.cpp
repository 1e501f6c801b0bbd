// SPDX-License-Identifier: Apache-2.0
#include "capture/resample.h"

#include <gtest/gtest.h>

#include <cmath>

#include "capture/spacing.h"
#include "tests/encoder/sphere_points.h"

namespace slf::resample_test {
namespace {

TEST(SurfacePointsTest, ASphereIsItsOwnNeighboursSurface) {
  const SurfacePoints points = sphere(4000);
  const SurfaceNeighbours near = find_neighbours(points, 12, 0.08, 2);
  for (const float distance : distance_to_neighbours(points, near, 2))
    EXPECT_NEAR(distance, 0, 1e-4);
  const auto normals = plane_normals(points, near, 2);
  // The spiral is not symmetric about a point: planes lean by a little of a spacing (0.056).
  for (std::size_t p = 0; p < points.size(); ++p)
    EXPECT_GT(dot(normals[p], points.normals[p]), 0.995f);
}

TEST(ResampleTest, PointsAreOnTheSurfaceAndCloseSmallHolesAndDropDuplicates) {
  SurfacePoints points = sphere(8000);
  const double spacing = typical_spacing(points.positions);
  SurfacePoints holed;
  for (std::size_t p = 0; p < points.size(); ++p)
    for (int copies = p % 7 == 0 ? 0 : 2; copies > 0; --copies) {
      holed.positions.push_back(points.positions[p]);
      holed.normals.push_back(points.normals[p]);
      holed.source.push_back(std::uint32_t(p));
    }
  const Lattice lattice{{-1.1, -1.1, -1.1}, spacing, {}};
  const SurfacePoints whole = resample(points, lattice, {}), mended = resample(holed, lattice, {});
  for (const Float3& p : mended.positions) EXPECT_NEAR(radius(p), 1, 0.1 * spacing);
  EXPECT_NEAR(double(mended.size()), double(whole.size()), 0.03 * double(whole.size()));
  for (const std::uint32_t source : mended.source) EXPECT_NE(source % 7, 0u);
}

TEST(ResampleTest, OnTheLatticePointsAreNodesWithinItsSize) {
  const SurfacePoints points = sphere(2000);
  ResampleSettings settings;
  settings.on_lattice = true;
  const Lattice lattice{{-1, -1, -1}, 0.125, {17, 17, 9}};
  const SurfacePoints nodes = resample(points, lattice, settings);
  ASSERT_GT(nodes.size(), 100u);
  for (const Float3& p : nodes.positions)
    for (std::size_t a = 0; a < 3; ++a) {
      const float node = (p[a] + 1) / 0.125f;
      EXPECT_FLOAT_EQ(node, std::round(node));
      EXPECT_LE(node, a == 2 ? 8 : 16);
      EXPECT_GE(node, 0);
    }
}

TEST(ResampleTest, NodesFarFromPlanesNeedNotBeLookedAt) {
  const SurfacePoints points = sphere(8000);
  const Lattice lattice{{-1.1, -1.1, -1.1}, typical_spacing(points.positions), {}};
  ResampleSettings near_planes;
  near_planes.off_plane = 0.8;
  EXPECT_EQ(resample(points, lattice, near_planes).positions,
            resample(points, lattice, {}).positions);
}

}  // namespace
}  // namespace slf::resample_test
