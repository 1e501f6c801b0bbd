// SPDX-License-Identifier: Apache-2.0
// Errors at points and in pictures, of known differences. Spec annex D.
#include "slf/evaluate.h"

#include <cmath>

#include "evaluate_support.h"

namespace slf::evaluate_test {
namespace {

using namespace test;

TEST_F(EvaluateTest, BothPsnrsAreThoseOfAKnownDifference) {
  const ViewMaps maps(constant_light_field(test::plane(32, 0), {{100, 110, 120}}, 5));
  add_photograph({103, 110, 116});
  add_photograph({100, 112, 120});
  const std::vector<int> cameras{0, 1};
  const auto quality = evaluate(maps, capture_, cameras, {});
  ASSERT_TRUE(quality) << quality.error().message;
  EXPECT_EQ(quality->points[0].observations, 2u * 32 * 32);
  // Luma of the errors (3, 0, -4) and (0, -2, 0).
  const double first = 0.2126 * 3 - 0.0722 * 4, second = 0.7152 * 2;
  EXPECT_NEAR(quality->points[0].luma_psnr,
              10 * std::log10(255.0 * 255 * 2 / (first * first + second * second)), 1e-9);
  // Errors 3, 0, 4 and 0, 2, 0: mean square over two cameras and three channels 29 / 6.
  EXPECT_NEAR(quality->points[0].psnr, 10 * std::log10(255.0 * 255 * 6 / 29), 1e-9);
  EXPECT_NEAR(quality->points[0].channel_psnr[0], 10 * std::log10(255.0 * 255 * 2 / 9), 1e-9);
  EXPECT_NEAR(quality->points[0].channel_psnr[1], 10 * std::log10(255.0 * 255 * 2 / 4), 1e-9);
  EXPECT_NEAR(quality->points[0].channel_psnr[2], 10 * std::log10(255.0 * 255 * 2 / 16), 1e-9);
  // The plate covers the image, so the pictures differ by the same everywhere.
  EXPECT_NEAR(quality->image.psnr, quality->points[0].psnr, 0.3);
  ASSERT_EQ(quality->image.psnr_each.size(), 2u);
  EXPECT_NEAR(quality->image.psnr_each[0], 10 * std::log10(255.0 * 255 * 3 / 25), 0.3);
  EXPECT_GT(quality->image.coverage, 0.99);
}

TEST_F(EvaluateTest, RadianceIsClampedAndRoundedBeforeItIsCompared) {
  LightField field = constant_light_field(test::plane(32, 0), {{0, 0, 0}}, 5);
  for (std::size_t i = 0; i < field.components.size(); i += 3) {
    field.components[i] = 100 * 16 + 7;  // 100.4375 -> 100
    field.components[i + 1] = 300 * 16;  // -> 255
    field.components[i + 2] = -50 * 16;  // -> 0
  }
  const ViewMaps maps(field);
  add_photograph({101, 255, 0});
  const std::vector<int> cameras{0};
  EvaluateSettings settings;
  settings.images = false;
  const auto quality = evaluate(maps, capture_, cameras, settings);
  ASSERT_TRUE(quality) << quality.error().message;
  EXPECT_NEAR(quality->points[0].channel_psnr[0], 20 * std::log10(255.0), 1e-9);
  EXPECT_TRUE(std::isinf(quality->points[0].channel_psnr[1]));
  EXPECT_TRUE(std::isinf(quality->points[0].channel_psnr[2]));
  EXPECT_TRUE(quality->image.psnr_each.empty());
}

TEST_F(EvaluateTest, EachDeltaCountsTheViewsThatOneMeasuredAloneWould) {
  // Seen from near, the points of the plate fall into cones of all widths.
  const ViewMaps maps(constant_light_field(test::plane(32, 0), {{100, 0, 0}, {0, 90, 250}}, 5));
  add_photograph({90, 20, 100});
  capture_.cameras[0] = frontal_camera(15.5, 15.5, 10, kSize, 1.0);
  const std::vector<int> cameras{0};
  EvaluateSettings settings;
  settings.images = false;
  settings.deltas_degrees = {30, 0, 45};
  const auto together = evaluate(maps, capture_, cameras, settings);
  ASSERT_TRUE(together) << together.error().message;
  ASSERT_EQ(together->points.size(), 3u);
  for (std::size_t d = 0; d < 3; ++d) {
    EvaluateSettings alone = settings;
    alone.deltas_degrees = {settings.deltas_degrees[d]};
    const auto quality = evaluate(maps, capture_, cameras, alone);
    ASSERT_TRUE(quality) << quality.error().message;
    EXPECT_EQ(together->points[d].delta_degrees, settings.deltas_degrees[d]);
    EXPECT_EQ(together->points[d].observations, quality->points[0].observations);
    EXPECT_EQ(together->points[d].psnr, quality->points[0].psnr);
    EXPECT_EQ(together->points[d].luma_psnr, quality->points[0].luma_psnr);
  }
  EXPECT_LT(together->points[2].observations, together->points[0].observations);
  EXPECT_LT(together->points[0].observations, together->points[1].observations);
}

TEST_F(EvaluateTest, TheSameForAnyThreadCount) {
  const ViewMaps maps(constant_light_field(test::plane(32, 0), {{90, 1, 7}, {50, 60, 250}}, 5));
  for (int i = 0; i < 5; ++i) add_photograph({30 * i, 255 - 40 * i, 100});
  const std::vector<int> cameras{0, 1, 2, 3, 4};
  std::vector<Quality> qualities;
  for (const int threads : {1, 2, 7}) {
    EvaluateSettings settings;
    settings.threads = threads;
    const auto quality = evaluate(maps, capture_, cameras, settings);
    ASSERT_TRUE(quality) << quality.error().message;
    qualities.push_back(*quality);
  }
  for (const Quality& other : qualities) {
    EXPECT_EQ(other.points[0].psnr, qualities[0].points[0].psnr);
    EXPECT_EQ(other.image.psnr, qualities[0].image.psnr);
    EXPECT_EQ(other.image.psnr_each, qualities[0].image.psnr_each);
    EXPECT_EQ(other.image.coverage, qualities[0].image.coverage);
    EXPECT_EQ(other.image.all.psnr, qualities[0].image.all.psnr);
    EXPECT_EQ(other.image.ms_ssim, qualities[0].image.ms_ssim);
    EXPECT_EQ(other.image.rim.error_share, qualities[0].image.rim.error_share);
  }
}

TEST_F(EvaluateTest, PicturesAreJudgedWhereTheCaptureHidesAllPoints) {
  const ViewMaps maps(constant_light_field(test::plane(32, 0), {{100, 100, 100}}, 5));
  add_photograph({110, 100, 100});
  for (auto& position : capture_.cloud.positions) position[2] -= 40;
  const std::vector<int> first{0};
  const auto quality = evaluate(maps, capture_, first, {});
  ASSERT_TRUE(quality) << quality.error().message;
  EXPECT_EQ(quality->points[0].observations, 0u);
  EXPECT_TRUE(std::isnan(quality->points[0].psnr));
  EXPECT_NEAR(quality->image.psnr, 10 * std::log10(255.0 * 255 * 3 / 100), 0.3);
  EvaluateSettings points_alone;
  points_alone.images = false;
  const auto refused = evaluate(maps, capture_, first, points_alone);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("no camera sees any point"), std::string::npos);
}

TEST_F(EvaluateTest, WhatCannotBeEvaluatedIsRefused) {
  const ViewMaps maps(constant_light_field(test::plane(32, 0), {{90, 90, 90}}, 5));
  add_photograph({90, 90, 90});
  EXPECT_FALSE(evaluate(maps, capture_, {}, {}));
  const std::vector<int> beyond{1}, first{0};
  EXPECT_FALSE(evaluate(maps, capture_, beyond, {}));
  const ViewMaps none(constant_light_field({}, {{0, 0, 0}}, 5));
  EXPECT_FALSE(evaluate(none, capture_, first, {}));
  EvaluateSettings settings;
  for (const std::vector<double>& deltas : {std::vector<double>{}, {-1}, {10, 91}}) {
    settings.deltas_degrees = deltas;
    EXPECT_FALSE(evaluate(maps, capture_, first, settings));
  }
  fs::remove(capture_.image_files[0]);
  EXPECT_FALSE(evaluate(maps, capture_, first, {}));
  capture_.cloud = {};
  EXPECT_FALSE(evaluate(maps, capture_, first, {}));
}

}  // namespace
}  // namespace slf::evaluate_test
