// SPDX-License-Identifier: Apache-2.0
// Mixing of several predictions of one decision in the logistic domain: 8 inputs and 8 weights of
// 16 bits. Spec 8.3.3.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "entropy/eight_lanes.h"
#include "entropy/logistic.h"

namespace slf {

/// Vectors of weights of which a context selects one; 13 fractional bits.
class WeightSets {
 public:
  WeightSets(std::size_t sets, std::int16_t first) : weights_(sets, EightLanes(first)) {}

  EightLanes& operator[](std::size_t set) { return weights_[set]; }

 private:
  std::vector<EightLanes> weights_;
};

/// P(1) of 65536 of a logistic value in 1/256. No decision is cheaper than 1/2070 of a bit, so that
/// a byte bounds the work it asks for.
inline std::uint32_t bounded_probability(std::int32_t logistic) {
  constexpr std::int32_t kLimit = 2047;
  return static_cast<std::uint32_t>(squash(std::clamp(logistic, -kLimit, kLimit)));
}

/// The probability that the sum of kSets selected vectors gives, and what learning from the
/// decision needs.
template <std::size_t kSets>
class Mixed {
 public:
  Mixed(EightLanes inputs, const std::array<EightLanes*, kSets>& weights)
      : inputs_(inputs), weights_(weights) {
    EightLanes sum = *weights_[0];
    for (std::size_t i = 1; i < kSets; ++i) sum = sum.saturating_plus(*weights_[i]);
    p1_ = bounded_probability(sum.dot(inputs_) >> 13);
  }

  std::uint32_t p1() const { return p1_; }  ///< of 65536

  /// Moves the weights along the gradient of the code length. rate: 1 .. 8.
  void update(unsigned bit, std::int32_t rate) const {
    const std::int32_t error =
        static_cast<std::int32_t>(bit << 16) - static_cast<std::int32_t>(p1_);
    const EightLanes step = inputs_.times(error * rate >> 5);
    for (EightLanes* const weights : weights_) *weights = weights->saturating_plus(step);
  }

 private:
  EightLanes inputs_;
  std::array<EightLanes*, kSets> weights_;
  std::uint32_t p1_;
};

}  // namespace slf
