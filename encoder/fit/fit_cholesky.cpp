// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/fit_cholesky.h"

#include <algorithm>
#include <cmath>

#include "base/multiversion.h"

namespace slf {
namespace {

template <class Real>
inline void factorise(Real* matrix, std::size_t n, Real floor) {
  for (std::size_t k = 0; k < n; ++k) {
    Real* __restrict column = matrix + packed_column(n, k);
    const std::size_t rows = n - k;
    const auto row_k = [&](std::size_t j) { return matrix + packed_column(n, j) + (k - j); };
    std::size_t j = 0;
    for (; j + 4 <= k; j += 4) {  // four columns a pass: one store for four products
      const Real *a = row_k(j), *b = row_k(j + 1), *c = row_k(j + 2), *d = row_k(j + 3);
      const Real fa = a[0], fb = b[0], fc = c[0], fd = d[0];
      for (std::size_t i = 0; i < rows; ++i)
        column[i] -= (fa * a[i] + fb * b[i]) + (fc * c[i] + fd * d[i]);
    }
    for (; j < k; ++j) {
      const Real* a = row_k(j);
      const Real fa = a[0];
      for (std::size_t i = 0; i < rows; ++i) column[i] -= fa * a[i];
    }
    const Real inverse = 1 / std::sqrt(std::max(column[0], floor));
    for (std::size_t i = 1; i < rows; ++i) column[i] *= inverse;
    column[0] = inverse;
  }
}

template <class Real, class Right>
inline void solve(const Real* factor, std::size_t n, Right* x) {
  constexpr std::size_t kRights = std::tuple_size_v<decltype(x->c)>;
  constexpr std::size_t kSums = 4;  // that do not wait for each other
  const auto column = [&](std::size_t j) { return factor + packed_column(n, j) - j; };  // [i]
  std::size_t j = 0;
  for (; j + 2 <= n; j += 2) {
    const Real *a = column(j), *b = column(j + 1);
    Right first = x[j], second = x[j + 1];
    for (std::size_t c = 0; c < kRights; ++c) {
      first.c[c] *= a[j];
      second.c[c] = (second.c[c] - a[j + 1] * first.c[c]) * b[j + 1];
    }
    x[j] = first;
    x[j + 1] = second;
    for (std::size_t i = j + 2; i < n; ++i)
      for (std::size_t c = 0; c < kRights; ++c) x[i].c[c] -= a[i] * first.c[c] + b[i] * second.c[c];
  }
  if (j < n)
    for (Real& c : x[j].c) c *= column(j)[j];
  for (j = n; j-- > 0;) {
    const Real* l = column(j);
    std::array<Right, kSums> sum{};
    std::size_t i = j + 1;
    for (; i + kSums <= n; i += kSums)
      for (std::size_t s = 0; s < kSums; ++s)
        for (std::size_t c = 0; c < kRights; ++c) sum[s].c[c] += l[i + s] * x[i + s].c[c];
    for (; i < n; ++i)
      for (std::size_t c = 0; c < kRights; ++c) sum[0].c[c] += l[i] * x[i].c[c];
    for (std::size_t c = 0; c < kRights; ++c)
      x[j].c[c] = (x[j].c[c] - ((sum[0].c[c] + sum[1].c[c]) + (sum[2].c[c] + sum[3].c[c]))) * l[j];
  }
}

}  // namespace

SLF_MULTIVERSION_LANES void cholesky_factorise(float* matrix, std::size_t n, float floor) {
  factorise(matrix, n, floor);
}

SLF_MULTIVERSION_LANES void cholesky_factorise(double* matrix, std::size_t n, double floor) {
  factorise(matrix, n, floor);
}

SLF_MULTIVERSION_LANES void cholesky_solve(const float* factor, std::size_t n, Lanes<float>* x) {
  solve(factor, n, x);
}

SLF_MULTIVERSION_LANES void cholesky_solve(const double* factor, std::size_t n, Lanes<double>* x) {
  solve(factor, n, x);
}

SLF_MULTIVERSION_LANES void cholesky_solve(const float* factor, std::size_t n, ManyLanes* x) {
  solve(factor, n, x);
}

}  // namespace slf
