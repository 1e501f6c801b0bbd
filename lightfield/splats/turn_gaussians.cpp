// SPDX-License-Identifier: Apache-2.0
#include "lightfield/splats/turn_gaussians.h"

#include <algorithm>
#include <cmath>

#include "base/quaternion.h"
#include "base/vec3.h"
#include "lightfield/harmonics.h"
#include "lightfield/splats/splat_directions.h"

namespace slf {
namespace {

constexpr std::size_t kTurnDirections = 64;  // of 9 functions at most: well determined

/// Solves m x = b for symmetric positive definite m [n][n], in place, with n columns of b.
void solve_symmetric(std::vector<double>& m, std::vector<double>& b, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = m[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= m[i * n + k] * m[j * n + k];
      m[i * n + j] = i == j ? std::sqrt(sum) : sum / m[j * n + j];
    }
  for (std::size_t c = 0; c < n; ++c) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < i; ++k) b[i * n + c] -= m[i * n + k] * b[k * n + c];
      b[i * n + c] /= m[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t k = i + 1; k < n; ++k) b[i * n + c] -= m[k * n + i] * b[k * n + c];
      b[i * n + c] /= m[i * n + i];
    }
  }
}

std::array<float, 4> product(const std::array<double, 4>& a, const std::array<float, 4>& q) {
  const double w = double{q[0]}, x = double{q[1]}, y = double{q[2]}, z = double{q[3]};
  return {static_cast<float>(a[0] * w - a[1] * x - a[2] * y - a[3] * z),
          static_cast<float>(a[0] * x + a[1] * w + a[2] * z - a[3] * y),
          static_cast<float>(a[0] * y - a[1] * z + a[2] * w + a[3] * x),
          static_cast<float>(a[0] * z + a[1] * y - a[2] * x + a[3] * w)};
}

/// A splat is the same seen in a point's mirror, and a rotation is left of rows that mirror.
AxisRows without_mirror(AxisRows rows) {
  if (dot(cross(rows[0], rows[1]), rows[2]) < 0)
    for (Vec3& row : rows)
      for (double& x : row) x = -x;
  return rows;
}

/// Rows: the axes that a file wants.
AxisRows rows_to(const Gaussians& gaussians, SplatAxes axes) {
  LightFieldHeader header;
  header.up = gaussians.up == UpAxis::kUnknown ? UpAxis::kMinusY : gaussians.up;
  return axis_rows(header, axes);
}

}  // namespace

// Functions of a degree turn among themselves: c'(Rv) = c(v) for all v gives A c' = B c, with rows
// of the functions along Rv and v.
HarmonicTurn::HarmonicTurn(const AxisRows& rows, int degree) {
  const Harmonics harmonics(degree);
  const auto directions = even_directions(kTurnDirections, 0);
  const auto count = std::size_t(harmonics.size());
  std::vector<double> before(directions.size() * count), after(before.size());
  for (std::size_t i = 0; i < directions.size(); ++i) {
    harmonics.evaluate(directions[i], &before[i * count]);
    harmonics.evaluate(turned(rows, directions[i]), &after[i * count]);
  }
  for (std::size_t l = 1; l <= std::size_t(degree); ++l) {
    const std::size_t n = 2 * l + 1, first = l * l;
    std::vector<double> square(n * n), mixed(n * n);
    for (std::size_t i = 0; i < directions.size(); ++i)
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b) {
          const double own = after[i * count + first + a];
          square[a * n + b] += own * after[i * count + first + b];
          mixed[a * n + b] += own * before[i * count + first + b];
        }
    solve_symmetric(square, mixed, n);
    for (double& x : mixed)  // a turn by right angles changes signs and places, and no digits
      if (std::abs(x - std::round(x)) < 1e-9) x = std::round(x);
    matrices_.push_back(std::move(mixed));
  }
}

void HarmonicTurn::apply(float* coefficients) const {
  for (std::size_t l = 1; l <= matrices_.size(); ++l) {
    const std::size_t n = 2 * l + 1;
    float* own = coefficients + 3 * l * l;
    std::array<double, 27> sums{};
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b < n; ++b)
        for (std::size_t c = 0; c < 3; ++c)
          sums[3 * a + c] += matrices_[l - 1][a * n + b] * double{own[3 * b + c]};
    for (std::size_t i = 0; i < 3 * n; ++i) own[i] = static_cast<float>(sums[i]);
  }
}

void move_gaussians(Gaussians& gaussians, const AxisRows& rows, double scale) {
  const HarmonicTurn turn(rows, gaussians.degree);
  const auto q = quaternion_of(without_mirror(rows));
  const auto log_scale = static_cast<float>(std::log(scale));
  const std::size_t row = 3 * gaussians.num_harmonics();
  for (std::size_t p = 0; p < gaussians.size(); ++p) {
    const Vec3 at = turned(rows, to_double(gaussians.positions[p]));
    for (std::size_t k = 0; k < 3; ++k) {
      gaussians.positions[p][k] = static_cast<float>(scale * at[k]);
      gaussians.log_deviations[p][k] += log_scale;
    }
    gaussians.rotations[p] = product(q, gaussians.rotations[p]);
    turn.apply(&gaussians.harmonics[p * row]);
  }
}

double extent_of(const Gaussians& gaussians) {
  double extent = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [low, high] =
        std::minmax_element(gaussians.positions.begin(), gaussians.positions.end(),
                            [k](const auto& a, const auto& b) { return a[k] < b[k]; });
    if (low == gaussians.positions.end()) return 0;
    extent = std::max(extent, double{(*high)[k]} - double{(*low)[k]});
  }
  return extent;
}

void shift_gaussians(Gaussians& gaussians, const Vec3& by) {
  constexpr double kFar = 1 << 10;  // extents: 14 bits are left of a float's 24
  const double extent = extent_of(gaussians);
  const double most = std::max({std::abs(by[0]), std::abs(by[1]), std::abs(by[2])});
  if (gaussians.origin != Vec3{0, 0, 0} || most > kFar * (extent > 0 ? extent : 1)) {
    gaussians.origin = plus(gaussians.origin, by);
    return;
  }
  for (auto& at : gaussians.positions) at = to_float(plus(to_double(at), by));
}

Gaussians in_axes(Gaussians gaussians, SplatAxes axes) {
  const AxisRows rows = rows_to(gaussians, axes);
  if (rows != AxisRows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}) {
    move_gaussians(gaussians, rows, 1);
    gaussians.origin = turned(rows, gaussians.origin);
  }
  if (axes != SplatAxes::kWorld)
    gaussians.up = axes == SplatAxes::kYUp ? UpAxis::kPlusY : UpAxis::kMinusY;
  return gaussians;
}

}  // namespace slf
