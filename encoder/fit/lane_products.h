// SPDX-License-Identifier: Apache-2.0
// Sums of products of long rows of floats, sixteen lanes at a time: the normal equations of the
// fit.
#pragma once

#include <cstddef>

#include "encoder/fit/fit_cholesky.h"

namespace slf {

/// Floats worked on together.
inline constexpr std::size_t kProductLanes = 16;

/// n, up to whole lanes.
constexpr std::size_t padded(std::size_t n) {
  return (n + kProductLanes - 1) / kProductLanes * kProductLanes;
}

/// c[i][j] += sum_q b[q][i] a[q][j], rows of c as far apart as those of a. Each sum is in the order
/// of q. O(count * rows * columns).
/// @param rows     of c: a multiple of 4, at most b_stride
/// @param columns  of c: a multiple of kProductLanes, at most a_stride
void add_products(std::size_t count, const float* b, std::size_t b_stride, std::size_t rows,
                  const float* a, std::size_t a_stride, std::size_t columns, float* c);

/// c += a^T a: the lower triangle, of what is above it an undefined part.
/// @param a  [count][width]
/// @param c  [width][width]; width: a multiple of kProductLanes
void add_square(std::size_t count, const float* a, std::size_t width, float* c);

/// Rows less their mean.
/// @param rows  [count][width]
/// @param mean  [width] receives it
void centre_rows(std::size_t count, float* rows, std::size_t width, float* mean);

/// y[q] = sum_m rows[q][m] x[m].
/// @param rows  [count][width], of which the first n of each count
/// @param x  [n]
/// @param y  [count]
void row_products(std::size_t count, const float* rows, std::size_t width, std::size_t n,
                  const Lanes<float>* x, Lanes<float>* y);

}  // namespace slf
