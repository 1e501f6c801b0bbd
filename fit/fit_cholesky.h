// Cholesky factors of small symmetric matrices, packed: column j of the lower triangle holds rows
// j .. n-1, columns follow each other. Half the memory of a square, which is what is kept per
// point. The diagonal of a factor holds the reciprocals of the pivots.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace slf {

/// Three channels and a lane of padding, so that a vector register holds one right-hand side row.
template <class Real>
struct alignas(4 * sizeof(Real)) Lanes {
  std::array<Real, 4> c{};
};

inline std::size_t packed_size(std::size_t n) { return n * (n + 1) / 2; }

/// Start of column j in a packed triangle of n rows.
inline std::size_t packed_column(std::size_t n, std::size_t j) { return j * n - (j * j - j) / 2; }

/// In place. @param floor  a positive lower bound of the pivots, which rounding must not undercut
template <class Real>
void cholesky_factorise(Real* matrix, std::size_t n, Real floor) {
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

/// x becomes the solution of L L^T x = x.
template <class Real>
void cholesky_solve(const Real* factor, std::size_t n, Lanes<Real>* x) {
  for (std::size_t j = 0; j < n; ++j) {
    const Real* column = factor + packed_column(n, j);
    for (Real& c : x[j].c) c *= column[0];
    const Lanes<Real> solved = x[j];
    for (std::size_t i = j + 1; i < n; ++i)
      for (std::size_t c = 0; c < 4; ++c) x[i].c[c] -= column[i - j] * solved.c[c];
  }
  for (std::size_t j = n; j-- > 0;) {
    const Real* column = factor + packed_column(n, j);
    Lanes<Real> sum = x[j];
    for (std::size_t i = j + 1; i < n; ++i)
      for (std::size_t c = 0; c < 4; ++c) sum.c[c] -= column[i - j] * x[i].c[c];
    for (std::size_t c = 0; c < 4; ++c) x[j].c[c] = sum.c[c] * column[0];
  }
}

}  // namespace slf
