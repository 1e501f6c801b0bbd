// SPDX-License-Identifier: Apache-2.0
// Observation with known answers: one camera that looks along +z at points in front of it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lightfield/colour.h"
#include "observe_support.h"

namespace slf::observe_test {
namespace {

using namespace test;

TEST(Observe, SamplesBilinearlyWithPixelCentresAtOneHalf) {
  // (2.5, 3.5) is the centre of pixel (2, 3); (3.25, 1.75) lies 3/4 from 2 to 3 and 1/4 from 1
  // to 2.
  const auto seen = see({{at(2.5, 3.5, 2), at(3.25, 1.75, 2)}, {kTowards, kTowards}}, {}, {});
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_NEAR(seen[0].colour[0], 20, 1e-4);  // corner-based sampling would give 25, floor 30
  EXPECT_NEAR(seen[0].colour[1], 60, 1e-4);
  EXPECT_NEAR(seen[1].colour[0], 27.5, 1e-4);
  EXPECT_NEAR(seen[1].colour[1], 25, 1e-4);
  EXPECT_NEAR(seen[1].colour[2], 7, 1e-5);
}

TEST(Observe, RepeatsTheEdgeWithinTheOuterHalfPixelAndNothingOutside) {
  const auto corner = see({{at(0.1, 5.9, 2)}, {kTowards}}, {}, {});
  ASSERT_EQ(corner.size(), 1u);
  EXPECT_NEAR(corner[0].colour[0], 0, 1e-4);
  EXPECT_NEAR(corner[0].colour[1], 100, 1e-4);
  EXPECT_FALSE(sees(at(-0.1, 3, 2), {}, {}));
  EXPECT_FALSE(sees(at(8.1, 3, 2), {}, {}));
  EXPECT_FALSE(sees(at(4, 6.1, 2), {}, {}));
  EXPECT_FALSE(sees({0, 0, -2}, {}, {}, {0, 0, 1}));  // behind the camera, facing it
}

TEST(Observe, DirectionPointsFromThePointToTheCamera) {
  const auto seen = see({{{0, 3, 4}}, {{0, -0.6f, -0.8f}}}, {}, {});
  EXPECT_TRUE(seen.empty());  // v = 3 + 7.5 is outside
  const auto inside = see({{{0.3f, 0.4f, 12}}, {kTowards}}, {}, {});
  ASSERT_EQ(inside.size(), 1u);
  const double length = std::sqrt(0.25 + 144);
  EXPECT_NEAR(inside[0].direction[0], std::atan2(-0.4, -0.3), 1e-6);
  EXPECT_NEAR(inside[0].direction[1], -12 / length, 1e-6);
}

TEST(Observe, TheConeEndsAtNinetyDegreesMinusDelta) {
  const auto tilted = [](double degrees) {
    const double a = degrees * std::numbers::pi / 180;
    return std::array<float, 3>{static_cast<float>(std::sin(a)), 0,
                                static_cast<float>(-std::cos(a))};
  };
  ObserveSettings settings;
  settings.delta_degrees = 10;
  EXPECT_TRUE(sees({0, 0, 2}, {}, settings, tilted(79.99)));
  EXPECT_FALSE(sees({0, 0, 2}, {}, settings, tilted(80.01)));
  settings.delta_degrees = 0;
  EXPECT_TRUE(sees({0, 0, 2}, {}, settings, tilted(89.99)));
  EXPECT_FALSE(sees({0, 0, 2}, {}, settings, tilted(90.01)));
  EXPECT_FALSE(sees({0, 0, 2}, {}, settings, {0, 0, 1}));
}

TEST(Observe, AMaskedPixelInTheFootprintDropsTheSample) {
  Image image = ramp(4);
  image.data[4 * (3 * 8 + 2) + 3] = 0;  // pixel (2, 3)
  const auto seen_at = [&](double u, double v) {
    return !see({{at(u, v, 2)}, {kTowards}}, {}, {}, image).empty();
  };
  EXPECT_FALSE(seen_at(2.5, 3.5));
  EXPECT_FALSE(seen_at(3.4, 3.5));
  EXPECT_FALSE(seen_at(1.6, 2.6));
  EXPECT_TRUE(seen_at(3.6, 3.5));
  EXPECT_TRUE(seen_at(2.5, 4.6));
}

TEST(Observe, LinearTransferIsTakenBeforeTheMixture) {
  Image image{2, 1, 3, {0, 0, 0, 255, 255, 188}};
  std::array<float, 256> linear{};
  for (int i = 0; i < 256; ++i)
    linear[static_cast<std::size_t>(i)] = static_cast<float>(255 * srgb_to_linear(i / 255.0));
  std::array<float, 3> colour{};
  ASSERT_TRUE(sample_bilinear(image, 1.0, 0.5, linear, colour));
  EXPECT_NEAR(colour[0], 127.5, 1e-4);
  EXPECT_NEAR(colour[2], 255 * 0.5028865 / 2, 1e-3);  // ((188/255 + 0.055) / 1.055)^2.4

  ObserveSettings settings;
  settings.transfer = Transfer::kLinear;
  const auto seen = see({{at(2.5, 3.5, 2)}, {kTowards}}, {}, settings);
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_NEAR(seen[0].colour[0], 255 * srgb_to_linear(20 / 255.0), 1e-4);
}

TEST(TransferCurve, HasThePublishedValuesAndInverse) {
  EXPECT_NEAR(srgb_to_linear(0.5), 0.2140411, 1e-7);
  EXPECT_NEAR(srgb_to_linear(0.04), 0.04 / 12.92, 1e-12);
  for (const double v : {0.0, 0.002, 0.03, 0.5, 1.0})
    EXPECT_NEAR(linear_to_srgb(srgb_to_linear(v)), v, 1e-9);
}

}  // namespace
}  // namespace slf::observe_test
