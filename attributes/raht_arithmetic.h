// The arithmetic of a merge, both ways. Spec 8.6.2.
#pragma once

#include <cstdint>

namespace slf {

/// x / 2^30 rounded to nearest, ties away from zero. |x| < 2^62.
constexpr std::int32_t round_q30(std::int64_t x) {
  constexpr std::int64_t kHalf = std::int64_t{1} << 29;
  return static_cast<std::int32_t>((x + kHalf - (x < 0 ? 1 : 0)) >> 30);
}

// The butterflies run on AVX2 where there is: integers, so the result is the same.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define SLF_MULTIVERSION __attribute__((target_clones("avx2", "default")))
#else
#define SLF_MULTIVERSION
#endif

}  // namespace slf
