// Mixing of several predictions of one decision in the logistic domain, in integers. Spec 8.3.3.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "bitstream/multiversion.h"

namespace slf {

/// Logistic values are ln(p / (1 - p)) in 1/256, within -2815 .. 2815.
inline constexpr int kLogisticLimit = 2815;

/// round(65536 / (1 + exp(-i / 4))). Spec table 8-2.
inline constexpr std::array<int, 45> kSquashQuarters = {
    32768, 36843, 40793, 44511, 47911, 50941, 53581, 55834, 57724, 59287, 60565, 61598,
    62428, 63090, 63615, 64030, 64357, 64614, 64816, 64974, 65097, 65194, 65269, 65328,
    65374, 65410, 65438, 65459, 65476, 65489, 65500, 65508, 65514, 65519, 65523, 65526,
    65528, 65530, 65531, 65532, 65533, 65534, 65534, 65535, 65535};

/// Probability of 65536 of a logistic value, by value + kLogisticLimit: linear between the entries
/// of table 8-2.
inline constexpr std::array<std::uint16_t, 2 * kLogisticLimit + 1> kSquash = [] {
  std::array<std::uint16_t, 2 * kLogisticLimit + 1> table{};
  for (int a = 0; a <= kLogisticLimit; ++a) {
    const std::size_t i = static_cast<std::size_t>(a) / 64;
    const int p =
        kSquashQuarters[i] + ((kSquashQuarters[i + 1] - kSquashQuarters[i]) * (a % 64) >> 6);
    table[static_cast<std::size_t>(kLogisticLimit - a)] = static_cast<std::uint16_t>(65536 - p);
    table[static_cast<std::size_t>(kLogisticLimit + a)] = static_cast<std::uint16_t>(p);
  }
  return table;
}();

constexpr int squash(int logistic) {
  const int x = std::clamp(logistic, -kLogisticLimit, kLogisticLimit);
  return kSquash[static_cast<std::size_t>(x + kLogisticLimit)];
}

/// The inverse of squash on the upper 12 bits of a probability: the smallest logistic value whose
/// probability is at least the middle of the interval.
inline constexpr std::array<std::int16_t, 4096> kStretch = [] {
  std::array<std::int16_t, 4096> table{};
  int x = -kLogisticLimit;
  for (int i = 0; i < 4096; ++i) {
    while (x < kLogisticLimit && squash(x) < 16 * i + 8) ++x;
    table[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(x);
  }
  return table;
}();

inline int stretch(std::uint32_t p1) { return kStretch[p1 >> 4]; }  // p1 < 65536

/// Calls body(0 .. kInputs - 1). A loop over few inputs is fastest unrolled: a vector of values
/// that were just stored one by one would have to wait for them.
template <std::size_t kInputs, class Body>
void for_inputs(Body body) {
  if constexpr (kInputs < 8) {
    for (std::size_t i = 0; i < kInputs; ++i) body(i);
  } else {
    SLF_VECTORISE
    for (std::size_t i = 0; i < kInputs; ++i) body(i);
  }
}

/// The logistic value that weights gave, and what learning from the decision needs.
struct Mixed {
  static constexpr std::int32_t kWeightLimit = 1 << 22;

  std::int32_t* weights;
  int logistic;

  /// Moves the weights along the gradient of the code length. rate: 8, 16, .. 40, a multiple of 8
  /// so that (input * error * rate + 2^19) >> 20 needs 32 bits; |input| <= 2815.
  template <std::size_t kInputs>
  void update(const std::array<int, kInputs>& inputs, unsigned bit, int rate) const {
    const int error = ((bit ? 65536 : 0) - squash(logistic)) * (rate / 8);
    for_inputs<kInputs>([w = weights, in = inputs.data(), error](std::size_t i) {
      w[i] = std::clamp(w[i] + ((in[i] * error + (1 << 16)) >> 17), -kWeightLimit, kWeightLimit);
    });
  }
};

/// A set of weight vectors of which a context selects one; the weighted sum of logistic
/// predictions.
template <std::size_t kInputs, std::size_t kSets>
class Mixer {
 public:
  explicit Mixer(int first_weight_q16) { weights_.fill(first_weight_q16); }

  Mixed mix(const std::array<int, kInputs>& inputs, std::size_t set) {
    std::int32_t* weights = &weights_[set * kInputs];
    std::int64_t sum = 0;
    for_inputs<kInputs>([&](std::size_t i) { sum += std::int64_t{weights[i]} * inputs[i]; });
    sum = std::clamp<std::int64_t>(sum >> 16, -kLogisticLimit, kLogisticLimit);
    return {weights, static_cast<int>(sum)};
  }

 private:
  std::array<std::int32_t, kInputs * kSets> weights_;
};

}  // namespace slf
