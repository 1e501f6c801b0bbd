// SPDX-License-Identifier: Apache-2.0
// One ridge penalty, all points: the solves of one equation of the paper, with factors kept between
// sweeps where memory allows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "encoder/fit/fit_solver.h"
#include "slf/fit.h"

namespace slf {

/// Keeps a reference to the observations.
class RidgeStep {
 public:
  /// @param penalty  >= 0; 0 is solved as a least-norm problem around zero
  /// @param solves  how often every point will be solved; factors are kept where that is more than
  /// once
  RidgeStep(const Observations& observations, const FitSettings& settings, double penalty,
            int solves);

  /// Solves points [begin, end); those without observations are left as they are. Ranges without a
  /// common point may run in parallel.
  /// @param coefficients  [P][K][3] of all points: m before, a after
  void solve(std::size_t begin, std::size_t end, float* coefficients);

  PointObservations seen(std::size_t point) const;

 private:
  template <class Real>
  void solve_ridge(std::size_t begin, std::size_t end, float* coefficients);
  void solve_least_norm(std::size_t begin, std::size_t end, float* coefficients) const;

  const Observations& observations_;
  Basis basis_;
  bool penalise_dc_;
  double penalty_;
  std::vector<std::size_t> first_;  // [P + 1] into kept_; empty where nothing is kept
  std::unique_ptr<float[]> kept_;
  std::vector<std::uint8_t> has_factor_;  // [P]
};

}  // namespace slf
