// SPDX-License-Identifier: Apache-2.0
// Cholesky factors of small symmetric matrices, packed: column j of the lower triangle holds rows
// j .. n-1, columns follow each other. Half the memory of a square, which is what is kept per
// point. The diagonal of a factor holds the reciprocals of the pivots.
#pragma once

#include <array>
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

/// In place, O(n^3). @param floor  a positive lower bound of the pivots, which rounding must not
/// undercut
void cholesky_factorise(float* matrix, std::size_t n, float floor);
void cholesky_factorise(double* matrix, std::size_t n, double floor);

/// x becomes the solution of L L^T x = x.
void cholesky_solve(const float* factor, std::size_t n, Lanes<float>* x);
void cholesky_solve(const double* factor, std::size_t n, Lanes<double>* x);

/// The same of sixteen right-hand sides.
struct alignas(64) ManyLanes {
  std::array<float, 16> c{};
};
void cholesky_solve(const float* factor, std::size_t n, ManyLanes* x);

}  // namespace slf
