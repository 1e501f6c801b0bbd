// SPDX-License-Identifier: Apache-2.0
#include "lightfield/basis_table.h"

#include <cmath>

#include "slf/view_map.h"

namespace slf {
namespace {

std::size_t wrap(int j, int size) { return static_cast<std::size_t>(j & (size - 1)); }

/// N_o(x) = 2^(1-o) sum_l binom(o, l) N_o(2x - l): a spline on `coarse.size()` cells on twice as
/// many.
std::vector<double> refine(int order, const std::vector<double>& coarse) {
  const int fine_size = static_cast<int>(2 * coarse.size());
  std::vector<double> fine(coarse.size() * 2, 0.0);
  double weight = std::ldexp(1.0, 1 - order);  // 2^(1-o) binom(o, l)
  for (int l = 0; l <= order; ++l) {
    for (std::size_t j = 0; j < coarse.size(); ++j)
      fine[wrap(2 * static_cast<int>(j) + l, fine_size)] += weight * coarse[j];
    weight = weight * (order - l) / (l + 1);
  }
  return fine;
}

/// w_i, i >= 1, on the 2^(k+1) cells on which a wavelet of scale k is a spline.
std::vector<double> wavelet_spline(int order, int i) {
  const int scale = wavelet_scale(i);
  const int offset = i - (1 << scale);
  const int size = 2 << scale;
  std::vector<double> spline(static_cast<std::size_t>(size), 0.0);
  const auto q = wavelet_taps(order);
  for (int n = 0; n <= 3 * order - 2; ++n)
    spline[wrap(2 * offset + n, size)] += q[static_cast<std::size_t>(n)];
  return spline;
}

}  // namespace

SplineTaps spline_taps(int order, int size, double x) {
  const double t = x * size;
  const int cell = static_cast<int>(t);
  const double u = t - cell, v = 1 - u;
  SplineTaps taps{};
  for (int i = 0; i < order; ++i)
    taps.index[static_cast<std::size_t>(i)] = (cell - order + 1 + i) & (size - 1);
  switch (order) {  // N_o(u + o - 1), ..., N_o(u)
    case 1:
      taps.weight = {1, 0, 0, 0};
      break;
    case 2:
      taps.weight = {v, u, 0, 0};
      break;
    case 3:
      taps.weight = {v * v / 2, 0.5 + u * v, u * u / 2, 0};
      break;
    default:
      taps.weight = {v * v * v / 6, (4 + u * u * (3 * u - 6)) / 6, (4 + v * v * (3 * v - 6)) / 6,
                     u * u * u / 6};
  }
  return taps;
}

AxisTable::AxisTable(int order, int scales) : order_(order), size_(1 << scales) {
  coefficients_.assign(static_cast<std::size_t>(size_) * static_cast<std::size_t>(size_), 1.0);
  for (int i = 1; i < size_; ++i) {
    std::vector<double> spline = wavelet_spline(order, i);
    while (static_cast<int>(spline.size()) < size_) spline = refine(order, spline);
    for (int j = 0; j < size_; ++j)
      coefficients_[static_cast<std::size_t>(i * size_ + j)] = spline[static_cast<std::size_t>(j)];
  }
}

double AxisTable::inner_product(int i, int j) const {
  // The integral of N_o(x) N_o(x - d) is N_2o(o + d); cells are 1 / n wide.
  double sum = 0;
  for (int a = 0; a < size_; ++a)
    for (int d = 1 - order_; d < order_; ++d)
      sum += coefficient(i, a) * coefficient(j, static_cast<int>(wrap(a + d, size_))) *
             cardinal_bspline(2 * order_, order_ + d);
  return sum / size_;
}

std::vector<double> basis_norms(const Basis& basis) {
  if (basis.id == BasisId::kHarmonics)
    return std::vector<double>(static_cast<std::size_t>(basis.num_functions()), 1.0);
  // (theta, gamma) is equal-area, so the mean over the sphere is the product of the axis means.
  const AxisTable theta(basis.order, basis.scales_theta), gamma(basis.order, basis.scales_gamma);
  std::vector<double> norms;
  norms.reserve(static_cast<std::size_t>(basis.num_functions()));
  for (int i1 = 0; i1 < gamma.size(); ++i1)
    for (int i0 = 0; i0 < theta.size(); ++i0)
      norms.push_back(std::sqrt(theta.inner_product(i0, i0) * gamma.inner_product(i1, i1)));
  return norms;
}

}  // namespace slf
