// SPDX-License-Identifier: Apache-2.0
// Morton order: x least significant. Spec 6.2.
#pragma once

#include <cstdint>

#include "slf/types.h"

namespace slf {

/// Spreads the lower 21 bits of v to every third bit.
constexpr std::uint64_t spread_by_three(std::uint64_t v) {
  v = (v | v << 32) & 0x001F00000000FFFFu;
  v = (v | v << 16) & 0x001F0000FF0000FFu;
  v = (v | v << 8) & 0x100F00F00F00F00Fu;
  v = (v | v << 4) & 0x10C30C30C30C30C3u;
  return (v | v << 2) & 0x1249249249249249u;
}

/// The inverse of spread_by_three; other bits are ignored.
constexpr std::uint64_t gather_by_three(std::uint64_t v) {
  v &= 0x1249249249249249u;
  v = (v | v >> 2) & 0x10C30C30C30C30C3u;
  v = (v | v >> 4) & 0x100F00F00F00F00Fu;
  v = (v | v >> 8) & 0x001F0000FF0000FFu;
  v = (v | v >> 16) & 0x001F00000000FFFFu;
  return (v | v >> 32) & 0x1FFFFFu;
}

/// Bit i of x, y, z goes to bit 3i, 3i + 1, 3i + 2. Coordinates 0 .. 2^21 - 1.
constexpr std::uint64_t morton(const Voxel& v) {
  return spread_by_three(static_cast<std::uint64_t>(v[0])) |
         spread_by_three(static_cast<std::uint64_t>(v[1])) << 1 |
         spread_by_three(static_cast<std::uint64_t>(v[2])) << 2;
}

constexpr Voxel from_morton(std::uint64_t code) {
  return {static_cast<std::int32_t>(gather_by_three(code)),
          static_cast<std::int32_t>(gather_by_three(code >> 1)),
          static_cast<std::int32_t>(gather_by_three(code >> 2))};
}

}  // namespace slf
