// SPDX-License-Identifier: Apache-2.0
// The fit without a ridge: among the coefficients that fit the observations best, the smallest.
#pragma once

#include "encoder/fit/fit_solver.h"

namespace slf {

/// min |a|^2 among the minimisers of |c - G a|^2. Where function 0 is not penalised, a_0 is left
/// out of the norm. Double precision, complete orthogonal decomposition: slow, for lambda = 0.
/// @param seen  M >= 1 observations
/// @param coefficients  [K][3], receives a
void fit_least_norm(const Basis& basis, bool penalise_dc, const PointObservations& seen,
                    float* coefficients);

}  // namespace slf
