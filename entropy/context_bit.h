// The state of one context of a mixed decision, in 16 bits. Spec 8.3.5.
#pragma once

#include <array>
#include <cstdint>

#include "entropy/logistic.h"

namespace slf {

/// P(bit = 1) in 12 fractional bits and the number of decisions seen, at most 15, in 4. The n-th
/// decision moves the probability by 1/(n + 1.5) of the error: the mean of what was seen at first,
/// forgetting afterwards.
class ContextBit {
 public:
  /// What a mixer is given.
  std::int16_t logistic() const { return kInput[state_ >> 4]; }

  void update(unsigned bit) {
    const std::uint32_t n = state_ & 15;
    const std::int32_t target = static_cast<std::int32_t>(0u - bit) & 0xFFF0;
    const std::int32_t error = target - static_cast<std::int32_t>(state_ & 0xFFF0u);
    const std::int32_t step = ((error * kRate[n] + (1 << 19)) >> 20) * 16;
    state_ = static_cast<std::uint16_t>(static_cast<std::int32_t>(state_) + step + kSeen[n]);
  }

 private:
  /// round(65536 / (n + 1.5)). Spec table 8-1.
  static constexpr std::array<std::int32_t, 16> kRate = [] {
    std::array<std::int32_t, 16> table{};
    for (int n = 0; n < 16; ++n)
      table[static_cast<std::size_t>(n)] = (131072 + (2 * n + 3) / 2) / (2 * n + 3);
    return table;
  }();
  static constexpr std::array<std::int32_t, 16> kSeen = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0};
  /// stretch of the probability; 0 of one half, which is what a context never seen has.
  static constexpr std::array<std::int16_t, 4096> kInput = [] {
    std::array<std::int16_t, 4096> table = kStretch;
    table[2048] = 0;
    return table;
  }();

  std::uint16_t state_ = 1u << 15;
};

}  // namespace slf
