// SPDX-License-Identifier: Apache-2.0
// Numbers that look random and depend on nothing but a place and a seed.
#pragma once

#include <cmath>
#include <cstdint>

#include "tools/synth/vec.h"

namespace slf::synth {

/// A permutation of 32 bits without visible structure (Wellons 2018, "lowbias32").
inline std::uint32_t mixed(std::uint32_t x) {
  x = (x ^ x >> 16) * 0x7feb352du;
  x = (x ^ x >> 15) * 0x846ca68bu;
  return x ^ x >> 16;
}

inline std::uint32_t mixed(std::uint32_t seed, std::uint32_t a) {
  return mixed(seed * 0x9e3779b9u + mixed(a));
}

/// 0 .. 1, 1 excluded.
inline double unit(std::uint32_t bits) { return static_cast<double>(bits) * 0x1p-32; }
inline double unit(std::uint32_t seed, std::uint32_t a) { return unit(mixed(seed, a)); }

/// Bits of a cell of the plane; any integers.
inline std::uint32_t cell_bits(double column, double row, std::uint32_t seed) {
  const auto word = [](double x) {
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(x) & 0xffffffff);
  };
  return mixed(mixed(seed, word(column)), word(row));
}

/// Values 0 .. 1 at the corners of unit cells, smooth between them.
inline double value_noise(double x, double y, std::uint32_t seed) {
  const double column = std::floor(x), row = std::floor(y);
  const double u = smoothstep(0, 1, x - column), v = smoothstep(0, 1, y - row);
  const auto corner = [&](int i, int j) { return unit(cell_bits(column + i, row + j, seed)); };
  const double low = corner(0, 0) + u * (corner(1, 0) - corner(0, 0));
  const double high = corner(0, 1) + u * (corner(1, 1) - corner(0, 1));
  return low + v * (high - low);
}

/// Three octaves, 0 .. 1.
inline double cloudy_noise(double x, double y, std::uint32_t seed) {
  return (4 * value_noise(x, y, seed) + 2 * value_noise(2.03 * x + 7, 2.03 * y, seed + 1) +
          value_noise(4.1 * x, 4.1 * y + 3, seed + 2)) /
         7;
}

}  // namespace slf::synth
