// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/training_rates.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/multiversion.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr double kTail = 0.15;                          // of the iterations, at the end
constexpr double kFirstMove = 0.15, kLastMove = 0.004;  // pixels, from the first to the last
constexpr float kTurnRate = 5e-3f, kRadiusRate = 1e-2f, kOpacityRate = 5e-2f;
constexpr float kColourRate = 5e-3f;
constexpr std::size_t kHarmonics = TrainedSurfel::kColour + 3;  // after the mean colour

constexpr std::size_t kHarmonicValues = TrainedSurfel::kSize - kHarmonics;

SLF_MULTIVERSION_LANES void draw_to_none(const std::array<float, kHarmonicValues>& steps,
                                         float* values) {
  for (std::size_t k = 0; k < kHarmonicValues; ++k)
    values[k] = std::copysign(std::max(std::abs(values[k]) - steps[k], 0.0f), values[k]);
}

}  // namespace

TrainedSurfel training_rates(double done, double pixel, const HarmonicSettings& harmonics) {
  const auto functions = std::size_t((harmonics.degree + 1) * (harmonics.degree + 1));
  TrainedSurfel rates;
  const auto tail = float(done > 1 - kTail ? std::pow(0.1, (done - (1 - kTail)) / kTail) : 1);
  const auto move = float(pixel * kFirstMove * std::pow(kLastMove / kFirstMove, done));
  for (std::size_t k = 0; k < TrainedSurfel::kColour + 3 * functions; ++k)
    rates.value[k] = k < TrainedSurfel::kTurn        ? move
                     : k < TrainedSurfel::kLogRadius ? tail * kTurnRate
                     : k < TrainedSurfel::kOpacity   ? tail * kRadiusRate
                     : k < TrainedSurfel::kColour    ? tail * kOpacityRate
                     : k < kHarmonics                ? tail * kColourRate
                                                     : tail * harmonics.rate;
  return rates;
}

void shrink_harmonics(float sparsity, const TrainedSurfel& rates,
                      std::span<const std::uint8_t> moving, int threads, TrainedSurfels& surfels) {
  if (sparsity <= 0) return;
  std::array<float, kHarmonicValues> steps;
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k] = sparsity * rates.value[kHarmonics + k];
  parallel_ranges(surfels.size(), 2048, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (moving.empty() || moving[i]) draw_to_none(steps, &surfels[i].value[kHarmonics]);
  });
}

}  // namespace slf
