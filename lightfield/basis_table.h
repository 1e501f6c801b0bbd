// SPDX-License-Identifier: Apache-2.0
// One axis of the basis in B-spline form: for order o the functions w_0 .. w_(n-1), n = 2^s, span
// exactly the periodic splines of order o on n equal cells, so each is a sum of n shifted
// B-splines.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "lightfield/basis.h"

namespace slf {

/// The B-splines N_o(n x - j) that are not zero at x: j = index[0 .. o-1], modulo n, with their
/// values.
struct SplineTaps {
  std::array<int, kMaxSplineOrder> index;
  std::array<double, kMaxSplineOrder> weight;
};

/// @param x  in [0, 1)
SplineTaps spline_taps(int order, int size, double x);

class AxisTable {
 public:
  /// @param order  1 .. 4
  /// @param scales  0 .. 6
  AxisTable(int order, int scales);

  int order() const { return order_; }
  int size() const { return size_; }

  /// c(i, j) in w_i(x) = sum_j c(i, j) N_o(n x - j), all shifts modulo n.
  double coefficient(int i, int j) const {
    return coefficients_[static_cast<std::size_t>(i * size_ + j)];
  }

  /// w_0(x) .. w_(n-1)(x), o products each. `row` holds n values.
  template <class Real>
  void evaluate(double x, Real* row) const {
    const SplineTaps taps = spline_taps(order_, size_, x);
    for (int i = 0; i < size_; ++i) {
      double sum = 0;
      for (int t = 0; t < order_; ++t) {
        const auto tap = static_cast<std::size_t>(t);
        sum += taps.weight[tap] * coefficient(i, taps.index[tap]);
      }
      row[i] = static_cast<Real>(sum);
    }
  }

  /// Integral over the period of w_i(x) w_j(x): the Gram matrix of the axis.
  double inner_product(int i, int j) const;

 private:
  int order_, size_;
  std::vector<double> coefficients_;  // [n][n]
};

}  // namespace slf
