// SPDX-License-Identifier: Apache-2.0
// A quantiser's step, by which encoders divide as often as there are values. Informative.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "attributes/quantiser.h"

namespace slf {

/// Divides without a division: what it multiplies with is 2^64 / step rounded up, which is exact
/// for 32 bits (Lemire, Kaser, Kurz: Faster remainder by direct computation, 2019).
class QuantiserStep {
 public:
  /// step: 1 .. 2^27 - 1.
  explicit QuantiserStep(std::uint32_t step)
      : step_(step),
        most_(static_cast<std::uint32_t>((kCoefficientLimit - 1) / step)),
        low_((~std::uint64_t{0} / step + 1) & 0xFFFFFFFFu),
        high_((~std::uint64_t{0} / step >> 32) + (low_ == 0)) {}

  std::uint32_t step() const { return step_; }

  /// n / step, rounded down.
  std::uint64_t divide(std::uint64_t n) const {
    if (n >> 32 != 0) return n / step_;
    return (n * high_ + (n * low_ >> 32)) >> 32;
  }

  /// Nearest multiple that a decoder accepts, ties away from zero.
  std::int32_t quantise(std::int32_t coefficient) const {
    const auto size = static_cast<std::uint64_t>(std::abs(std::int64_t{coefficient}));
    const auto magnitude =
        static_cast<std::int32_t>(std::min<std::uint64_t>(divide(size + step_ / 2), most_));
    return coefficient < 0 ? -magnitude : magnitude;
  }

 private:
  std::uint32_t step_, most_;
  std::uint64_t low_, high_;
};

}  // namespace slf
