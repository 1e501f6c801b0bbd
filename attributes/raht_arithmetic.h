// The arithmetic of a merge, both ways. Spec 8.6.2.
#pragma once

#include <cstdint>

#include "attributes/raht_tree.h"

namespace slf {

/// x / 2^30 rounded to nearest, ties away from zero. |x| < 2^61, so the result has 32 bits and the
/// sign bits that a logical shift loses are not part of it; AVX2 has no other for 64 bits.
constexpr std::int32_t round_q30(std::int64_t x) {
  const auto bits = static_cast<std::uint64_t>(x);
  return static_cast<std::int32_t>((bits + (1u << 29) - (bits >> 63)) >> 30);
}

/// The butterfly of a merge, of both rows in one plane: values of left and right to the sum, which
/// stays in the left row, and the difference.
inline void forward_merge(const Merge& m, std::int32_t& left, std::int32_t& right) {
  const std::int32_t a = left, b = right;
  left = round_q30(std::int64_t{m.cos_q30} * a + std::int64_t{m.sin_q30} * b);
  right = round_q30(std::int64_t{m.cos_q30} * b - std::int64_t{m.sin_q30} * a);
}

/// And back. Spec 8.8.1.
inline void inverse_merge(const Merge& m, std::int32_t sum, std::int32_t difference,
                          std::int32_t& left, std::int32_t& right) {
  left = round_q30(std::int64_t{m.cos_q30} * sum - std::int64_t{m.sin_q30} * difference);
  right = round_q30(std::int64_t{m.sin_q30} * sum + std::int64_t{m.cos_q30} * difference);
}

}  // namespace slf
