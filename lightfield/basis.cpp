// SPDX-License-Identifier: Apache-2.0
#include "lightfield/basis.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lightfield/harmonics.h"
#include "slf/view_map.h"

namespace slf {
namespace {

double binomial(int n, int k) {
  double value = 1;
  for (int i = 0; i < k; ++i) value = value * (n - i) / (i + 1);
  return value;
}

double modulo_one(double x) {
  x -= std::floor(x);
  return x < 1 ? x : 0;  // -1e-20 rounds up to 1
}

/// psi_o: the wavelet of scale 0 before it is made periodic, support [0, 2o - 1].
double mother_wavelet(int order, double x) {
  static const std::array taps{wavelet_taps(1), wavelet_taps(2), wavelet_taps(3), wavelet_taps(4)};
  const auto& q = taps[static_cast<std::size_t>(order - 1)];
  double sum = 0;
  for (int n = 0; n <= 3 * order - 2; ++n)
    sum += q[static_cast<std::size_t>(n)] * cardinal_bspline(order, 2 * x - n);
  return sum;
}

}  // namespace

double cardinal_bspline(int order, double x) {
  if (x < 0 || x >= order) return 0;
  if (order == 1) return 1;
  return (x * cardinal_bspline(order - 1, x) + (order - x) * cardinal_bspline(order - 1, x - 1)) /
         (order - 1);
}

std::array<double, 3 * kMaxSplineOrder - 1> wavelet_taps(int order) {
  std::array<double, 3 * kMaxSplineOrder - 1> q{};
  for (int n = 0; n <= 3 * order - 2; ++n) {
    double sum = 0;
    for (int j = 0; j <= order; ++j)
      sum += binomial(order, j) * cardinal_bspline(2 * order, n - j + 1);
    q[static_cast<std::size_t>(n)] = (n % 2 == 0 ? 1 : -1) * std::ldexp(sum, 1 - order);
  }
  return q;
}

int wavelet_scale(int i) {
  int scale = 0;
  while (i >> (scale + 1) != 0) ++scale;
  return scale;
}

double wavelet_value(int order, int i, double x) {
  if (i == 0) return 1;
  const int scale = wavelet_scale(i);
  const int period = 1 << scale;
  // psi(t + m * period) for every m that reaches its support [0, 2o - 1]; t < period.
  const double t = std::ldexp(modulo_one(x), scale) - (i - period);
  double sum = 0;
  for (int shift = 0; t + shift < 2 * order - 1; shift += period)
    sum += mother_wavelet(order, t + shift);
  return sum;
}

double axis_of_theta(double theta) { return modulo_one(theta / (2 * std::numbers::pi)); }

double axis_of_gamma(double gamma) { return modulo_one(gamma / 2); }

std::array<float, 2> direction_of(const Vec3& v) {
  const double length = std::hypot(v[0], v[1], v[2]);
  return {static_cast<float>(std::atan2(v[1], v[0])), static_cast<float>(v[2] / length)};
}

double basis_value(const Basis& basis, int k, double theta, double gamma) {
  if (basis.id == BasisId::kHarmonics) {
    std::array<double, (kMaxDegree + 1) * (kMaxDegree + 1)> row;
    const double r = std::sqrt(std::max(0.0, 1 - gamma * gamma));
    Harmonics(basis.degree).evaluate({r * std::cos(theta), r * std::sin(theta), gamma}, row.data());
    return row[static_cast<std::size_t>(k)];
  }
  const int i0 = k & ((1 << basis.scales_theta) - 1);
  const int i1 = k >> basis.scales_theta;
  return wavelet_value(basis.order, i0, axis_of_theta(theta)) *
         wavelet_value(basis.order, i1, axis_of_gamma(gamma));
}

}  // namespace slf
