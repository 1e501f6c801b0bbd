// SPDX-License-Identifier: Apache-2.0
// The adaptive probability of one binary decision in one context. Spec 8.3.2.
#pragma once

#include <array>
#include <cstdint>

#include "entropy/table.h"

namespace slf {

inline constexpr int kProbabilityBits = 16;  ///< probabilities handed to the range coder

/// P(bit = 1) in 22 fractional bits and the number of decisions seen in 10, in one word. The n-th
/// decision moves the probability by 1/(n + 1.5) of the error until n reaches the caller's limit:
/// the mean of what was seen at first, exponential forgetting afterwards.
class AdaptiveBit {
 public:
  /// P(1) in 1 .. 65535, of 65536.
  std::uint32_t p1() const {
    const std::uint32_t p = state_ >> 16;
    return p == 0 ? 1 : p;
  }
  std::uint32_t count() const { return state_ & 1023; }

  /// limit: 1 .. 1023.
  void update(unsigned bit, std::uint32_t limit) {
    const std::uint32_t n = state_ & 1023;
    const std::int64_t p = state_ >> 10;
    const std::int64_t target = bit ? (1 << 22) - 1 : 0;
    const std::int64_t moved = p + ((target - p) * kReciprocal[n] >> 16);
    state_ = static_cast<std::uint32_t>(moved) << 10 | (n < limit ? n + 1 : n);
  }

 private:
  /// round(65536 / (n + 1.5)). Spec 8.3.2.
  SLF_TABLE_MEMBER std::array<std::uint32_t, 1024> kReciprocal = [] {
    SLF_TABLE_BEGINS;
    std::array<std::uint32_t, 1024> table{};
    for (std::uint32_t n = 0; n < 1024; ++n) table[n] = (131072 + (2 * n + 3) / 2) / (2 * n + 3);
    return table;
  }();

  std::uint32_t state_ = 1u << 31;
};

}  // namespace slf
