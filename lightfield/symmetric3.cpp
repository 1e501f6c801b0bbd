// SPDX-License-Identifier: Apache-2.0
#include "lightfield/symmetric3.h"

#include <cmath>
#include <cstddef>

namespace slf {
namespace {

constexpr int kSweeps = 12;  // each squares what is left; five do

/// Turns rows and columns p and q so that m[p][q] is 0. r: the third.
void rotate(Matrix3x3& m, Matrix3x3& axis, std::size_t p, std::size_t q, std::size_t r) {
  const double off = m[p][q];
  if (off == 0) return;
  const double theta = (m[q][q] - m[p][p]) / (2 * off);
  const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  m[p][p] -= t * off;
  m[q][q] += t * off;
  m[p][q] = m[q][p] = 0;
  const double a = m[r][p], b = m[r][q];
  m[r][p] = m[p][r] = c * a - s * b;
  m[r][q] = m[q][r] = s * a + c * b;
  for (auto& row : axis) {
    const double x = row[p], y = row[q];
    row[p] = c * x - s * y;
    row[q] = s * x + c * y;
  }
}

/// Elements beside the diagonal are less than the rounding of those on it.
bool is_diagonal(const Matrix3x3& m) {
  const double beside = std::abs(m[0][1]) + std::abs(m[0][2]) + std::abs(m[1][2]);
  return beside <= 0x1p-60 * (std::abs(m[0][0]) + std::abs(m[1][1]) + std::abs(m[2][2]));
}

}  // namespace

Symmetric3 from_shape_values(const std::array<double, 6>& v) {
  const double a = v[0] / std::sqrt(3.0), b = v[1] / std::sqrt(2.0), c = v[2] / std::sqrt(6.0);
  const double off = 1 / std::sqrt(2.0);
  return {a + b + c, a - b + c, a - 2 * c, v[3] * off, v[4] * off, v[5] * off};
}

std::array<double, 6> shape_values(const Symmetric3& m) {
  const double twice = std::sqrt(2.0);
  return {(m[0] + m[1] + m[2]) / std::sqrt(3.0),
          (m[0] - m[1]) / std::sqrt(2.0),
          (m[0] + m[1] - 2 * m[2]) / std::sqrt(6.0),
          m[3] * twice,
          m[4] * twice,
          m[5] * twice};
}

Axes3 eigen_axes(const Symmetric3& s) {
  Matrix3x3 m{{{s[0], s[3], s[4]}, {s[3], s[1], s[5]}, {s[4], s[5], s[2]}}};
  Axes3 axes{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {}};  // turned: right-handed it stays
  for (int sweep = 0; sweep < kSweeps && !is_diagonal(m); ++sweep) {
    rotate(m, axes.axis, 0, 1, 2);
    rotate(m, axes.axis, 0, 2, 1);
    rotate(m, axes.axis, 1, 2, 0);
  }
  for (std::size_t i = 0; i < 3; ++i) axes.value[i] = m[i][i];
  return axes;
}

Symmetric3 matrix_of(const Axes3& axes) {
  constexpr std::array<std::array<std::size_t, 2>, 6> kPlaces{
      {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};
  Symmetric3 out{};
  for (std::size_t e = 0; e < 6; ++e)
    for (std::size_t i = 0; i < 3; ++i)
      out[e] += axes.value[i] * axes.axis[kPlaces[e][0]][i] * axes.axis[kPlaces[e][1]][i];
  return out;
}

}  // namespace slf
