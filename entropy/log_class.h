// SPDX-License-Identifier: Apache-2.0
// Classes of a quantity for contexts: quarter octaves. Spec 8.3.6.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace slf {

/// 0 .. 3 for themselves, then four classes an octave: 4, 5, 6, 7, 8 - 9, 10 - 11, ...; at most
/// `most`.
constexpr std::uint32_t log_class(std::uint64_t n, std::uint32_t most) {
  const auto octave = static_cast<std::uint32_t>(std::bit_width(n | 4)) - 3;
  return std::min(4 * octave + static_cast<std::uint32_t>(n >> octave), most);
}

}  // namespace slf
