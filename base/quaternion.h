// SPDX-License-Identifier: Apache-2.0
// Quaternions w, x, y, z (Hamilton) and rotations.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace slf {

using Matrix3x3 = std::array<std::array<double, 3>, 3>;

/// @param q  of any length but 0
template <class Real>
Matrix3x3 rotation_of(const std::array<Real, 4>& q) {
  const auto w = double{q[0]}, x = double{q[1]}, y = double{q[2]}, z = double{q[3]};
  const double scale = 2 / (w * w + x * x + y * y + z * z);
  return {{{1 - scale * (y * y + z * z), scale * (x * y - w * z), scale * (x * z + w * y)},
           {scale * (x * y + w * z), 1 - scale * (x * x + z * z), scale * (y * z - w * x)},
           {scale * (x * z - w * y), scale * (y * z + w * x), 1 - scale * (x * x + y * y)}}};
}

/// A turn as w, x, y, z of length 1, w >= 0: by the largest of them, so that no digits are lost.
inline std::array<double, 4> quaternion_of(const Matrix3x3& m) {
  const std::array<double, 4> square{1 + m[0][0] + m[1][1] + m[2][2],  // 4 times those of w .. z
                                     1 + m[0][0] - m[1][1] - m[2][2],
                                     1 - m[0][0] + m[1][1] - m[2][2],
                                     1 - m[0][0] - m[1][1] + m[2][2]};
  std::size_t most = 0;
  for (std::size_t i = 1; i < 4; ++i)
    if (square[i] > square[most]) most = i;
  const double x = m[2][1] - m[1][2], y = m[0][2] - m[2][0], z = m[1][0] - m[0][1];
  const double xy = m[1][0] + m[0][1], xz = m[0][2] + m[2][0], yz = m[2][1] + m[1][2];
  const std::array<std::array<double, 4>, 4> times{{{square[0], x, y, z},
                                                    {x, square[1], xy, xz},
                                                    {y, xy, square[2], yz},
                                                    {z, xz, yz, square[3]}}};
  std::array<double, 4> q = times[most];
  double length = 0;
  for (const double v : q) length += v * v;
  length = std::copysign(std::sqrt(length), q[0]);
  for (double& v : q) v /= length;
  return q;
}

}  // namespace slf
