// SPDX-License-Identifier: Apache-2.0
// Eight pixels at a time, as vectors that every compiler has: four columns of two rows.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace slf {

/// What eight pixels have in common with a vector: lane 4 * row + column.
using Lanes [[gnu::vector_size(8 * sizeof(float))]] = float;
using LaneMask [[gnu::vector_size(sizeof(Lanes))]] = std::int32_t;

inline constexpr Lanes kColumns{0, 1, 2, 3, 0, 1, 2, 3};
inline constexpr Lanes kRows{0, 0, 0, 0, 1, 1, 1, 1};

// Vectors go by reference: without AVX a compiler has no way to hand them over by value that those
// with it share.

inline bool any(const LaneMask& mask) {
  const auto halves = __builtin_shufflevector(mask, mask, 0, 1, 2, 3) |
                      __builtin_shufflevector(mask, mask, 4, 5, 6, 7);
  std::array<std::uint64_t, 2> words;
  std::memcpy(words.data(), &halves, sizeof halves);
  return (words[0] | words[1]) != 0;
}

inline void set_root(const Lanes& square, Lanes& root) {
  std::array<float, 8> values;
  std::memcpy(values.data(), &square, sizeof square);
  for (float& value : values) value = std::sqrt(value);
  std::memcpy(&root, values.data(), sizeof root);
}

}  // namespace slf
