// SPDX-License-Identifier: Apache-2.0
// Uniform quantisation with a step per plane. Spec 8.7.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace slf {

/// Every reconstructed transform coefficient is below this in magnitude.
inline constexpr std::int64_t kCoefficientLimit = std::int64_t{1} << 27;

/// A quantised value to its coefficient, in place. missing: layers that would have refined it, 0 ..
/// 3: where the values between are not known, those nearer to zero are more likely. Spec 8.7.4.
/// False: it is too large.
[[nodiscard]] inline bool dequantise(std::int32_t& value, std::uint32_t step, int missing) {
  const std::int64_t whole = (std::abs(std::int64_t{value}) << missing) * step;
  if (whole >= kCoefficientLimit) return false;
  const std::int64_t inside = ((std::int64_t{3} << missing) - 3) * step / 8;
  const std::int64_t magnitude = value == 0 ? 0 : std::min(whole + inside, kCoefficientLimit - 1);
  value = static_cast<std::int32_t>(value < 0 ? -magnitude : magnitude);
  return true;
}

}  // namespace slf
