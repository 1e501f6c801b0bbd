// Uniform quantisation with a step per plane. Spec 8.7.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace slf {

/// Every reconstructed transform coefficient is below this in magnitude.
inline constexpr std::int64_t kCoefficientLimit = std::int64_t{1} << 27;

/// Nearest multiple that a decoder accepts, ties away from zero. Informative.
inline std::int32_t quantise(std::int32_t coefficient, std::uint32_t step) {
  const std::int64_t nearest = (std::abs(std::int64_t{coefficient}) + step / 2) / step;
  const std::int64_t magnitude = std::min(nearest, (kCoefficientLimit - 1) / step);
  return static_cast<std::int32_t>(coefficient < 0 ? -magnitude : magnitude);
}

}  // namespace slf
