// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/adam.h"

#include "base/multiversion.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr float kMeanDecay = 0.9f, kSquareDecay = 0.999f;
constexpr float kLeast = 1e-8f;  // gradients of a picture's sum are far larger, or nothing

SLF_MULTIVERSION_LANES void step_values(const float* gradient, const float* rates, float mean_scale,
                                        float square_scale, float* mean, float* square,
                                        float* value) {
  for (std::size_t k = 0; k < TrainedSurfel::kSize; ++k) {
    mean[k] = kMeanDecay * mean[k] + (1 - kMeanDecay) * gradient[k];
    square[k] = kSquareDecay * square[k] + (1 - kSquareDecay) * gradient[k] * gradient[k];
    value[k] -= rates[k] * mean[k] * mean_scale / (std::sqrt(square[k] * square_scale) + kLeast);
  }
}

}  // namespace

void AdamState::resize(std::size_t surfels) {
  mean.resize(surfels);
  square.resize(surfels);
}

void adam_step(const std::vector<TrainedSurfel>& gradients, const TrainedSurfel& rates,
               const ViewedSpace& space, int threads, AdamState& state, TrainedSurfels& surfels) {
  ++state.steps;
  const auto mean_scale = float(1 / (1 - std::pow(double(kMeanDecay), state.steps)));
  const auto square_scale = float(1 / (1 - std::pow(double(kSquareDecay), state.steps)));
  parallel_ranges(surfels.size(), 2048, threads, [&](std::size_t begin, std::size_t end) {
    TrainedSurfel there = rates;
    for (std::size_t i = begin; i < end; ++i) {
      const float larger = space.pixels_at(surfels[i].position());
      for (std::size_t k = TrainedSurfel::kPosition; k < TrainedSurfel::kTurn; ++k)
        there.value[k] = larger * rates.value[k];
      step_values(gradients[i].value.data(), there.value.data(), mean_scale, square_scale,
                  state.mean[i].value.data(), state.square[i].value.data(),
                  surfels[i].value.data());
    }
  });
}

}  // namespace slf
