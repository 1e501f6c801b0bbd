// SPDX-License-Identifier: Apache-2.0
// Whether a matrix that somebody gives is a rotation.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace slf {

using RotationRows = std::array<std::array<double, 3>, 3>;

inline double determinant(const RotationRows& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// Every entry of R R^T is that of the unit matrix to 0.001, which files with few digits keep;
/// false for NaN.
inline bool is_orthonormal(const RotationRows& r) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const double product = r[i][0] * r[j][0] + r[i][1] * r[j][1] + r[i][2] * r[j][2];
      if (!(std::abs(product - (i == j ? 1 : 0)) <= 1e-3)) return false;
    }
  return true;
}

/// Orthonormal, and no mirror.
inline bool is_rotation(const RotationRows& r) { return is_orthonormal(r) && determinant(r) > 0; }

}  // namespace slf
