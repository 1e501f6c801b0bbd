// SPDX-License-Identifier: Apache-2.0
// The ridge problems of one point (paper Eq. 2 and 3), solved through one Cholesky factor.
//
// Eq. 3 with d = lambda + beta and m = beta mean / d, and Eq. 2 with d = lambda and m = 0, both ask
// for
//     min |c - G a|^2 + d |a - m|^2.
// With r = c - G m the answer is a = m + G^T (G G^T + d I)^-1 r (dual, M x M) or, which is the
// same, a = m + (G^T G + d I)^-1 G^T r (primal, K x K). G itself is never applied as a matrix: G =
// W C with the map C to nodes and the o * o weights W of each direction.
//
// Function 0, the constant 1, without a penalty: the dual matrix loses its share 1 1^T, and the sum
// of the weights z must vanish (the derivative by a_0), which gives a_0 = w^T r / w^T 1 with
// w = S^-1 1; w is kept with the factor. The primal matrix lacks d at its first diagonal element.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "encoder/fit/fit_cholesky.h"
#include "lightfield/nodes.h"
#include "slf/types.h"

namespace slf {

/// What was seen of one point: M directions and their colours.
struct PointObservations {
  std::span<const std::array<float, 2>> directions;
  std::span<const std::array<float, 3>> colours;
};

/// One thread's solver: matrices of the basis, and scratch memory. Instantiated for float and
/// double.
template <class Real>
class RidgeSolver {
 public:
  RidgeSolver(const Basis& basis, bool penalise_dc);

  /// Elements of the factor of a point with M >= 1 observations.
  std::size_t factor_size(std::size_t observations) const;

  /// @param penalty  d > 0
  /// @param factor  receives factor_size(M) elements
  void factorise(std::span<const std::array<float, 2>> directions, double penalty, Real* factor);

  /// @param coefficients  [K][3]: takes m, returns a. m_0 does not matter where function 0 is not
  ///                      penalised
  void solve(const PointObservations& seen, const Real* factor, float* coefficients);

 private:
  bool dual(std::size_t observations) const { return observations < num_functions_; }
  void evaluate_rows(std::span<const std::array<float, 2>> directions);
  void dual_matrix(std::size_t observations, Real penalty, Real* matrix);
  void primal_matrix(std::size_t observations, Real penalty, Real* matrix) const;
  void compute_residual(const PointObservations& seen);
  void residual_to_weights(std::size_t observations, const Real* factor);
  void collect_weights(std::size_t observations);
  void solve_primal(const Real* factor);

  Basis basis_;
  bool penalise_dc_;
  AxisTable theta_, gamma_;
  NodeMap<Real> map_;
  std::size_t num_functions_;
  std::vector<Real> rows_theta_, rows_gamma_;  // [function of the axis][M]
  std::vector<Real> column_;                   // [M]
  std::vector<Lanes<Real>> residual_;          // [M]: r, then the weights z
  std::vector<Lanes<Real>> lanes_;             // [K]
  std::vector<NodeTaps> taps_;                 // [M]
  std::vector<Real> model_, change_;           // [K][3]: m; a - m
  std::vector<Real> nodes_, scratch_;          // [2^s0][2^s1][3]
  std::array<Real, 3> dc_{};                   // a_0 of the dual form without a penalty on it
};

}  // namespace slf
