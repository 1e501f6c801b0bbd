// SPDX-License-Identifier: Apache-2.0
// What the coefficient coders know of the arrays they work on. Spec 8.7.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "attributes/raht_tree.h"

namespace slf {

/// The quantised coefficients of a slice: [P][3 * K], row-major; function k, channel c at 3 k + c.
struct CoefficientRows {
  const RahtTree& tree;
  std::span<std::int32_t> values;
  std::size_t planes;
  std::span<std::uint8_t> nonzero = {};  ///< [P] 1: not all of a row is zero; empty: not asked for

  std::int32_t* row(std::size_t r) const { return values.data() + r * planes; }
  void set_nonzero(std::size_t r) const {
    if (!nonzero.empty()) nonzero[r] = 1;
  }
};

/// Have the functions' values one of these bits? By default: is one of them other than 0?
inline bool has_any(const std::int32_t* row, const std::vector<std::uint16_t>& functions,
                    std::int32_t bits = -1) {
  std::int32_t any = 0;
  for (const std::size_t f : functions) any |= row[3 * f] | row[3 * f + 1] | row[3 * f + 2];
  return (any & bits) != 0;
}

/// Values before a refinement are below this in magnitude, and so below 2^27 after it. Spec 8.7.7.
inline constexpr std::int32_t kRefinedLimit = 1 << 26;

}  // namespace slf
