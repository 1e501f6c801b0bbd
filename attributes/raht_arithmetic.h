// The arithmetic of a merge, both ways. Spec 8.6.2.
#pragma once

#include <cstdint>

namespace slf {

/// x / 2^30 rounded to nearest, ties away from zero. |x| < 2^61, so the result has 32 bits and the
/// sign bits that a logical shift loses are not part of it; AVX2 has no other for 64 bits.
constexpr std::int32_t round_q30(std::int64_t x) {
  const auto bits = static_cast<std::uint64_t>(x);
  return static_cast<std::int32_t>((bits + (1u << 29) - (bits >> 63)) >> 30);
}

}  // namespace slf
