// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/fit_least_norm.h"

#define EIGEN_MPL2_ONLY
#include <Eigen/QR>

namespace slf {

void fit_least_norm(const Basis& basis, bool penalise_dc, const PointObservations& seen,
                    float* coefficients) {
  const auto m = static_cast<Eigen::Index>(seen.directions.size());
  const AxisTable theta(basis.order, basis.scales_theta), gamma(basis.order, basis.scales_gamma);
  Eigen::VectorXd row_theta(theta.size()), row_gamma(gamma.size());
  Eigen::MatrixXd g(m, basis.num_functions()), c(m, 3);
  for (Eigen::Index j = 0; j < m; ++j) {
    const auto& direction = seen.directions[static_cast<std::size_t>(j)];
    theta.evaluate(axis_of_theta(static_cast<double>(direction[0])), row_theta.data());
    gamma.evaluate(axis_of_gamma(static_cast<double>(direction[1])), row_gamma.data());
    for (Eigen::Index i = 0; i < gamma.size(); ++i)
      g.row(j).segment(i * theta.size(), theta.size()) = row_gamma[i] * row_theta.transpose();
    for (Eigen::Index channel = 0; channel < 3; ++channel)
      c(j, channel) = static_cast<double>(
          seen.colours[static_cast<std::size_t>(j)][static_cast<std::size_t>(channel)]);
  }
  // A free a_0 takes the mean of what the others leave, so they see only deviations from means.
  const Eigen::RowVectorXd mean_g = g.colwise().mean(), mean_c = c.colwise().mean();
  if (!penalise_dc) {
    g.rowwise() -= mean_g;
    c.rowwise() -= mean_c;
  }
  Eigen::MatrixXd a = Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(g).solve(c);
  if (!penalise_dc) {
    a.row(0).setZero();
    a.row(0) = mean_c - mean_g * a;
  }
  for (Eigen::Index k = 0; k < a.rows(); ++k)
    for (Eigen::Index channel = 0; channel < 3; ++channel)
      coefficients[3 * k + channel] = static_cast<float>(a(k, channel));
}

}  // namespace slf
