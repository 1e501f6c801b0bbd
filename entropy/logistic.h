// SPDX-License-Identifier: Apache-2.0
// Probabilities and their logistic values, in integers. Spec 8.3.3.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "entropy/table.h"

namespace slf {

/// Logistic values are ln(p / (1 - p)) in 1/256, within -2815 .. 2815.
inline constexpr int kLogisticLimit = 2815;

/// round(65536 / (1 + exp(-i / 4))). Spec table A-1.
inline constexpr std::array<int, 45> kSquashQuarters = {
    32768, 36843, 40793, 44511, 47911, 50941, 53581, 55834, 57724, 59287, 60565, 61598,
    62428, 63090, 63615, 64030, 64357, 64614, 64816, 64974, 65097, 65194, 65269, 65328,
    65374, 65410, 65438, 65459, 65476, 65489, 65500, 65508, 65514, 65519, 65523, 65526,
    65528, 65530, 65531, 65532, 65533, 65534, 65534, 65535, 65535};

/// Probability of 65536 of a logistic value, by value + kLogisticLimit: linear between the entries
/// of table A-1.
SLF_TABLE std::array<std::uint16_t, 2 * kLogisticLimit + 1> kSquash = [] {
  SLF_TABLE_BEGINS;
  std::array<std::uint16_t, 2 * kLogisticLimit + 1> table{};
  for (int a = 0; a <= kLogisticLimit; ++a) {
    const std::size_t i = static_cast<std::size_t>(a) / 64;
    const int p =
        kSquashQuarters[i] + ((kSquashQuarters[i + 1] - kSquashQuarters[i]) * (a % 64) >> 6);
    table[static_cast<std::size_t>(kLogisticLimit - a)] = static_cast<std::uint16_t>(65536 - p);
    table[static_cast<std::size_t>(kLogisticLimit + a)] = static_cast<std::uint16_t>(p);
  }
  return table;
}();

SLF_TABLE_FUNCTION int squash(int logistic) {
  const int x = std::clamp(logistic, -kLogisticLimit, kLogisticLimit);
  return kSquash[static_cast<std::size_t>(x + kLogisticLimit)];
}

/// The inverse of squash on the upper 12 bits of a probability: the smallest logistic value whose
/// probability is at least the middle of the interval.
SLF_TABLE std::array<std::int16_t, 4096> kStretch = [] {
  SLF_TABLE_BEGINS;
  std::array<std::int16_t, 4096> table{};
  int x = -kLogisticLimit;
  for (int i = 0; i < 4096; ++i) {
    while (x < kLogisticLimit && squash(x) < 16 * i + 8) ++x;
    table[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(x);
  }
  return table;
}();

inline int stretch(std::uint32_t p1) { return kStretch[p1 >> 4]; }  // p1 < 65536

}  // namespace slf
