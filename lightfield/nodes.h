// SPDX-License-Identifier: Apache-2.0
// Between coefficients of the basis and coefficients of plain B-splines on a grid of directions
// (nodes; for order 2 simply the values there). A fixed separable map, exact because both span the
// same functions. A function of direction then costs o * o products instead of K.
#pragma once

#include <cstddef>
#include <vector>

#include "lightfield/basis_table.h"
#include "slf/types.h"

namespace slf {

/// The o * o nodes that are not zero along a direction, and their weights.
struct NodeTaps {
  std::size_t count = 0;                                            ///< o * o
  std::array<std::size_t, kMaxSplineOrder * kMaxSplineOrder> node;  ///< index into [2^s0][2^s1]
  std::array<double, kMaxSplineOrder * kMaxSplineOrder> weight;
};

NodeTaps node_taps(const Basis& basis, double theta, double gamma);

/// Coefficients are [2^s1][2^s0][3] (function k = i1 * 2^s0 + i0), nodes are [2^s0][2^s1][3].
/// Instantiated for float and double. Matrices are computed in double and rounded to Real.
template <class Real>
class NodeMap {
 public:
  explicit NodeMap(const Basis& basis);

  /// Elements of coefficients, of nodes and of the scratch both functions want.
  std::size_t size() const { return 3 * size_theta_ * size_gamma_; }

  /// nodes = C coefficients. Rows of coefficients that are all zero cost nothing.
  void to_nodes(const Real* coefficients, Real* nodes, Real* scratch) const;
  /// coefficients = C^T nodes: the transpose, not the inverse.
  void transposed(const Real* nodes, Real* coefficients, Real* scratch) const;

 private:
  std::size_t size_theta_, size_gamma_;
  std::vector<Real> theta_, gamma_;  // [function][node] of each axis
};

}  // namespace slf
