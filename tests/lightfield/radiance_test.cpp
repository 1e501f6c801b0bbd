// SPDX-License-Identifier: Apache-2.0
// Radiance of a point along a direction, worked out by hand. Spec 6.7.
#include <gtest/gtest.h>

#include "slf/view_map.h"

namespace slf::radiance_test {
namespace {

/// One point, order 2, 2 nodes of gamma: red is 100 + 80 w_1(gamma / 2), a triangle wave, so 20 at
/// gamma = 0 and 180 at gamma = +-1.
LightField triangle_in_gamma() {
  LightField field;
  field.header.basis = {BasisId::kBspline, 2, 0, 1};
  field.header.num_functions = 2;
  field.header.shift = {1, 2};
  field.positions = {{0, 0, 0}};
  field.components = {200, 0, -20, 320, 0, 0};
  return field;
}

TEST(Radiance, ATriangleWaveIsHandComputable) {
  const ViewMaps maps(triangle_in_gamma(), 1);
  EXPECT_NEAR(maps.radiance(0, 0.3f, 0.0f)[0], 20, 1e-4);
  EXPECT_NEAR(maps.radiance(0, -2.0f, 0.5f)[0], 100, 1e-4);
  EXPECT_NEAR(maps.radiance(0, 2.0f, -0.75f)[0], 140, 1e-4);
  EXPECT_NEAR(maps.radiance(0, 2.0f, 1.0f)[0], 180, 1e-4);
}

TEST(Radiance, BeyondTheGammaThatCamerasSawRepeatsTheLimit) {
  LightField field = triangle_in_gamma();
  field.header.gamma_min_q7 = 0;
  field.header.gamma_max_q7 = 64;
  const ViewMaps maps(field, 1);
  const float limit = 64.0f / 127;
  EXPECT_EQ(maps.radiance(0, 0, -0.9f), maps.radiance(0, 0, 0));
  EXPECT_EQ(maps.radiance(0, 0, 1.0f), maps.radiance(0, 0, limit));
  EXPECT_NE(maps.radiance_unclamped(0, 0, 1.0f), maps.radiance_unclamped(0, 0, limit));
}

TEST(Radiance, IsClampedToDisplayRangeAndTheMeanIsTheDc) {
  LightField field = triangle_in_gamma();
  field.components = {500, 100, -20, 320, 0, 0};
  const ViewMaps maps(field, 1);
  EXPECT_EQ(maps.radiance(0, 0, 1.0f)[0], 255);
  EXPECT_EQ(maps.radiance(0, 0, 1.0f)[2], 0);
  EXPECT_NEAR(maps.radiance_unclamped(0, 0, 1.0f)[0], 330, 1e-4);
  EXPECT_NEAR(maps.radiance_unclamped(0, 0, 1.0f)[2], -10, 1e-4);
  EXPECT_EQ(maps.mean(0), (std::array<float, 3>{250, 50, 0}));
}

TEST(ViewMaps, AFieldWithoutABasisOrWithOtherComponentsIsRefused) {
  const LightField sound = triangle_in_gamma();
  ASSERT_TRUE(ViewMaps::of(sound, 1));
  LightField without = sound, other_basis = sound, cut = sound;
  without.header.has_basis = false;
  other_basis.header.basis.scales_gamma = 2;
  cut.components.pop_back();
  for (const LightField* field : {&without, &other_basis, &cut}) {
    const auto maps = ViewMaps::of(*field, 1);
    ASSERT_FALSE(maps);
    EXPECT_EQ(maps.error().code, Errc::kInvalidArgument);
  }
}

}  // namespace
}  // namespace slf::radiance_test
