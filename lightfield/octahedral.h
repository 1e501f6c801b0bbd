// SPDX-License-Identifier: Apache-2.0
// Unit vectors as points of a square: the octahedral map. Spec 6.6.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace slf {

/// Square coordinates -1 .. 1 of a vector of any length > 0: projected onto |x| + |y| + |z| = 1,
/// the lower half folded outward.
inline std::array<double, 2> octahedral_from_vector(const std::array<double, 3>& v) {
  const double scale = 1 / (std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]));
  const double x = v[0] * scale, y = v[1] * scale;
  if (v[2] >= 0) return {x, y};
  return {std::copysign(1 - std::abs(y), x), std::copysign(1 - std::abs(x), y)};
}

/// The inverse; unit length.
inline std::array<double, 3> vector_from_octahedral(double a, double b) {
  const double z = 1 - std::abs(a) - std::abs(b);
  const double fold = std::max(-z, 0.0);
  const double x = a - std::copysign(fold, a), y = b - std::copysign(fold, b);
  const double scale = 1 / std::sqrt(x * x + y * y + z * z);
  return {x * scale, y * scale, z * scale};
}

/// Nearest of the 2^bits levels per coordinate; level q stands for 2 q / (2^bits - 1) - 1.
/// @param bits  4 .. 12
inline std::array<std::uint16_t, 2> quantise_normal(const std::array<double, 3>& v, int bits) {
  const auto square = octahedral_from_vector(v);
  const double top = (1 << bits) - 1;
  const auto level = [top](double c) {
    return static_cast<std::uint16_t>(std::floor(std::clamp((c + 1) / 2, 0.0, 1.0) * top + 0.5));
  };
  return {level(square[0]), level(square[1])};
}

/// @param bits  4 .. 12; levels beyond the range are taken as the last
inline std::array<double, 3> dequantise_normal(const std::array<std::uint16_t, 2>& q, int bits) {
  const double top = (1 << bits) - 1;
  const auto coordinate = [top](std::uint16_t level) {
    return std::min<double>(level, top) / top * 2 - 1;
  };
  return vector_from_octahedral(coordinate(q[0]), coordinate(q[1]));
}

}  // namespace slf
