// SPDX-License-Identifier: Apache-2.0
// Discs of points: their normals and radii. Spec annex E.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/morton.h"
#include "lightfield/render/render_surfels.h"
#include "lightfield/render/surfel_cloud.h"
#include "render_support.h"

namespace slf::surfel_cloud_test {
namespace {

using test::constant_light_field;

TEST(SurfelTest, NormalsOfAVoxelisedSphereAreRadial) {
  const auto voxels = test::sphere(64, 40);
  const Surfels surfels = estimate_surfels(voxels, 2);
  double worst = 1;
  for (std::size_t p = 0; p < voxels.size(); ++p) {
    double along = 0, length = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      along += (voxels[p][k] - 64) * double{surfels.normals[p][k]};
      length += (voxels[p][k] - 64.0) * (voxels[p][k] - 64.0);
    }
    worst = std::min(worst, std::abs(along) / std::sqrt(length));
    ASSERT_GE(surfels.radii[p], 0.9f);
    ASSERT_LT(surfels.radii[p], 2.0f);  // neighbours are one voxel apart
  }
  EXPECT_GT(worst, std::cos(15 * 3.14159265 / 180));  // quantisation tilts a patch of 5 voxels
}

TEST(SurfelTest, RadiusFollowsTheSpacingOfASparseCloud) {
  std::vector<Voxel> voxels;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) voxels.push_back({x * 8, y * 8, 100});
  const Surfels surfels = estimate_surfels(voxels, 1);
  for (std::size_t p = 0; p < voxels.size(); ++p) {
    ASSERT_NEAR(std::abs(surfels.normals[p][2]), 1, 1e-5);
    ASSERT_GT(surfels.radii[p], 8 / std::sqrt(2.0f));  // half the diagonal: no hole
    ASSERT_LT(surfels.radii[p], 24);
  }
}

TEST(SurfelTest, ADenseClusterBesideScatteredPointsHasItsOwnScale) {
  // As many points in a solid cube as in a lattice 1,000 times coarser: with one cell size for both
  // every point of the cube would look at the whole cube, 10^11 pairs, which no test outlasts.
  std::vector<Voxel> voxels;
  for (int z = 0; z < 64; ++z)
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        voxels.push_back({x, y, z});
        if (x + y + z > 0) voxels.push_back({1000 * x, 1000 * y, 1000 * z});
      }
  const Surfels surfels = estimate_surfels(voxels, 2);
  for (std::size_t p = 0; p < voxels.size(); ++p) {
    const Voxel& v = voxels[p];
    const int nearest = std::min({v[0], v[1], v[2]}), farthest = std::max({v[0], v[1], v[2]});
    if (nearest > 8 && farthest < 56) {
      ASSERT_LT(surfels.radii[p], 3);
    } else if (nearest >= 1000) {
      ASSERT_GT(surfels.radii[p], 500);
    }
  }
}

}  // namespace
}  // namespace slf::surfel_cloud_test
