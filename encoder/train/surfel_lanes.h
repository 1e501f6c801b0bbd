// SPDX-License-Identifier: Apache-2.0
// Rows of floats, of eight surfels or of what belongs to them, and back: lane i is the i-th row's.
#pragma once

#include <array>
#include <cstddef>
#include <cstring>

#include "lightfield/render/lanes.h"

namespace slf {

inline constexpr std::size_t kLaneCount = 8;

/// Rows to columns.
[[gnu::always_inline]] inline void transpose(std::array<Lanes, kLaneCount>& v) {
  std::array<Lanes, kLaneCount> two, four;
  for (std::size_t i = 0; i < 8; i += 2) {
    two[i] = __builtin_shufflevector(v[i], v[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    two[i + 1] = __builtin_shufflevector(v[i], v[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (std::size_t i = 0; i < 8; i += 4)
    for (std::size_t k = i; k < i + 2; ++k) {
      four[k] = __builtin_shufflevector(two[k], two[k + 2], 0, 1, 8, 9, 4, 5, 12, 13);
      four[k + 2] = __builtin_shufflevector(two[k], two[k + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  for (std::size_t i = 0; i < 4; ++i) {
    v[i] = __builtin_shufflevector(four[i], four[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    v[i + 4] = __builtin_shufflevector(four[i], four[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

/// Calls part(k) for every eight columns of rows of kSize from the k-th on; the last ones overlap.
template <std::size_t kSize, class Part>
[[gnu::always_inline]] inline void in_parts(const Part& part) {
  static_assert(kSize >= kLaneCount);
  for (std::size_t k = 0; k + kLaneCount <= kSize; k += kLaneCount) part(k);
  if constexpr (kSize % kLaneCount != 0) part(kSize - kLaneCount);
}

template <std::size_t kSize>
[[gnu::always_inline]] inline void load_rows(const std::array<const float*, kLaneCount>& rows,
                                             std::array<Lanes, kSize>& columns) {
  in_parts<kSize>([&](std::size_t k) {
    std::array<Lanes, kLaneCount> v;
    for (std::size_t i = 0; i < kLaneCount; ++i) std::memcpy(&v[i], rows[i] + k, sizeof v[i]);
    transpose(v);
    for (std::size_t i = 0; i < kLaneCount; ++i) columns[k + i] = v[i];
  });
}

/// The first `count` rows.
template <std::size_t kSize>
[[gnu::always_inline]] inline void store_rows(const std::array<Lanes, kSize>& columns,
                                              const std::array<float*, kLaneCount>& rows,
                                              std::size_t count) {
  in_parts<kSize>([&](std::size_t k) {
    std::array<Lanes, kLaneCount> v;
    for (std::size_t i = 0; i < kLaneCount; ++i) v[i] = columns[k + i];
    transpose(v);
    for (std::size_t i = 0; i < count; ++i) std::memcpy(rows[i] + k, &v[i], sizeof v[i]);
  });
}

}  // namespace slf
