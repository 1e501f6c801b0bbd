// SPDX-License-Identifier: Apache-2.0
// What depends on direction is kept where photographs agree on it, and nowhere else.
#include "encoder/train/training_rates.h"

#include <gtest/gtest.h>

#include "encoder/train/train_surfels.h"
#include "traced_scene.h"

namespace slf::training_rates_test {
namespace {

using Surfel = TrainedSurfel;
constexpr std::size_t kHarmonics = Surfel::kColour + 3;

TEST(TrainingRatesTest, FunctionsAboveTheDegreeAreNeverLearnt) {
  for (int degree = 0; degree <= 3; ++degree) {
    const TrainedSurfel rates = training_rates(0.5, 1, {.degree = degree});
    const auto learnt = Surfel::kColour + 3 * std::size_t((degree + 1) * (degree + 1));
    for (std::size_t k = 0; k < Surfel::kSize; ++k) EXPECT_EQ(rates.value[k] > 0, k < learnt) << k;
  }
}

TEST(TrainingRatesTest, HarmonicsAreDrawnToNoneAndNothingElseIs) {
  TrainedSurfel rates, surfel;
  rates.value.fill(0.1f);
  for (std::size_t k = 0; k < Surfel::kSize; ++k) surfel.value[k] = k % 2 ? 0.5f : -0.04f;
  TrainedSurfels surfels = {surfel, surfel};
  shrink_harmonics(0.5f, rates, std::vector<std::uint8_t>{1, 0}, 1, surfels);
  EXPECT_EQ(surfels[1].value, surfel.value) << "it stands still";
  for (std::size_t k = 0; k < Surfel::kSize; ++k)
    EXPECT_FLOAT_EQ(surfels[0].value[k], k < kHarmonics ? surfel.value[k] : k % 2 ? 0.45f : 0.0f);
}

TEST(TrainingRatesTest, WhatDoesNotBelongIsGoneAtTheEnd) {
  const test::TracedScene traced("vase", 3, 6, 64, 2000);
  const SurfacePoints points{traced.exact.positions, traced.exact.normals, {}};
  const auto views = load_training_views(traced.capture, traced.cameras, points, traced.step, 0, 0);
  ASSERT_TRUE(views);
  TrainedSurfels surfels = start_surfels(points, traced.step, *views, 300, kSolidOpacity, 0);
  const float middle = points.positions[points.size() / 2][0];
  TrainSettings settings;
  settings.iterations = 300;
  settings.belong = [&](const TrainedSurfels& all) {
    std::vector<std::uint8_t> right;
    for (const TrainedSurfel& one : all) right.push_back(one.position()[0] > middle);
    return right;
  };
  ASSERT_TRUE(train_surfels(*views, settings, surfels));
  ASSERT_FALSE(surfels.empty());
  for (const TrainedSurfel& one : surfels) EXPECT_GT(one.position()[0], middle - traced.step);
}

}  // namespace
}  // namespace slf::training_rates_test
