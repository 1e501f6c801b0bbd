// SPDX-License-Identifier: Apache-2.0
#include "codec/encoder/forward_columns.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>

#include "base/signed_index.h"

namespace slf {
namespace {

using Square = Eigen::MatrixXd;
using Square3 = Eigen::Matrix3d;

/// Weighted least squares of the columns.
std::vector<double> invert_columns(const PlaneTransform& t, const std::vector<double>& weights) {
  const std::size_t n = t.rows();
  Square coded(index(n), index(t.columns()));
  for (std::size_t c = 0; c < t.columns(); ++c)
    for (std::size_t i = 0; i < n; ++i)
      coded(index(i), index(c)) =
          std::ldexp(t.matrix[c * n + i], -PlaneTransform::kFractionBits) * std::sqrt(weights[i]);
  const Square inverse = Eigen::CompleteOrthogonalDecomposition<Square>(coded).pseudoInverse();
  std::vector<double> matrix;
  for (Eigen::Index c = 0; c < inverse.rows(); ++c)
    for (Eigen::Index i = 0; i < inverse.cols(); ++i)
      matrix.push_back(inverse(c, i) * std::sqrt(weights[static_cast<std::size_t>(i)]));
  return matrix;
}

}  // namespace

std::vector<double> weights_of_rows(const PlaneTransform& t, const std::vector<double>& weights) {
  const double unit = std::sqrt(weights[t.functions[0]]);
  std::vector<double> of_rows;
  for (std::size_t i = 0; i < t.rows(); ++i)
    of_rows.push_back(weights[t.functions[t.lanes == 3 ? i : i / 3]] / (unit * unit));
  return of_rows;
}

ForwardTransform forward_transform(PlaneTransform coded, std::vector<std::uint8_t> precision,
                                   const std::vector<double>& weights) {
  ForwardTransform forward;
  forward.inverse = std::move(coded);
  const PlaneTransform& t = forward.inverse;
  forward.precision = std::move(precision);
  forward.weights = weights_of_rows(t, weights);
  forward.matrix = invert_columns(t, forward.weights);
  Square3 colour;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t d = 0; d < 3; ++d)
      colour(index(i), index(d)) = t.colour[i][d] / double{1 << PlaneTransform::kColourBits};
  const Square3 inverse = colour.inverse();
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t d = 0; d < 3; ++d) forward.colour[i][d] = inverse(index(i), index(d));
  return forward;
}

}  // namespace slf
