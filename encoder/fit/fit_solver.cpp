// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/fit_solver.h"

#include <algorithm>

namespace slf {

template <class Real>
RidgeSolver<Real>::RidgeSolver(const Basis& basis, bool penalise_dc)
    : basis_(basis),
      penalise_dc_(penalise_dc),
      theta_(basis.order, basis.scales_theta),
      gamma_(basis.order, basis.scales_gamma),
      map_(basis),
      num_functions_(static_cast<std::size_t>(basis.num_functions())),
      lanes_(num_functions_),
      model_(map_.size()),
      change_(map_.size()),
      nodes_(map_.size()),
      scratch_(map_.size()) {}

template <class Real>
std::size_t RidgeSolver<Real>::factor_size(std::size_t observations) const {
  if (!dual(observations)) return packed_size(num_functions_);
  return packed_size(observations) + (penalise_dc_ ? 0 : observations);
}

template <class Real>
void RidgeSolver<Real>::factorise(std::span<const std::array<float, 2>> directions, double penalty,
                                  Real* factor) {
  const std::size_t m = directions.size();
  const auto d = static_cast<Real>(penalty);
  evaluate_rows(directions);
  if (!dual(m)) {
    primal_matrix(m, d, factor);
    cholesky_factorise(factor, num_functions_, std::min(d, Real{1}));
    return;
  }
  dual_matrix(m, d, factor);
  cholesky_factorise(factor, m, d);
  if (penalise_dc_) return;
  residual_.assign(m, {{1, 1, 1, 1}});
  cholesky_solve(factor, m, residual_.data());
  Real sum = 0;
  for (const auto& w : residual_) sum += w.c[0];
  Real* weights = factor + packed_size(m);  // w / w^T 1
  for (const auto& w : residual_) *weights++ = w.c[0] / sum;
}

template <class Real>
void RidgeSolver<Real>::evaluate_rows(std::span<const std::array<float, 2>> directions) {
  const std::size_t m = directions.size();
  const auto evaluate = [m](const AxisTable& table, std::size_t j, double x,
                            std::vector<Real>& rows) {
    std::array<Real, 64> row;  // 2^6 functions at most
    table.evaluate(x, row.data());
    for (std::size_t i = 0; i < static_cast<std::size_t>(table.size()); ++i)
      rows[i * m + j] = row[i];
  };
  rows_theta_.resize(m * static_cast<std::size_t>(theta_.size()));
  rows_gamma_.resize(m * static_cast<std::size_t>(gamma_.size()));
  for (std::size_t j = 0; j < m; ++j) {
    evaluate(theta_, j, axis_of_theta(static_cast<double>(directions[j][0])), rows_theta_);
    evaluate(gamma_, j, axis_of_gamma(static_cast<double>(directions[j][1])), rows_gamma_);
  }
}

namespace {

/// sum[i] = sum over rows of rows[r][j] rows[r][j + i]: a column of the axis' own G G^T.
template <class Real>
void gram_column(const std::vector<Real>& rows, std::size_t m, std::size_t j, Real* sum) {
  const std::size_t size = m - j;
  std::fill_n(sum, size, Real{0});
  for (const Real* row = rows.data() + j; row < rows.data() + rows.size(); row += m) {
    const Real factor = row[0];
    if (factor == 0) continue;  // wavelets are local
    for (std::size_t i = 0; i < size; ++i) sum[i] += factor * row[i];
  }
}

}  // namespace

template <class Real>
void RidgeSolver<Real>::dual_matrix(std::size_t m, Real penalty, Real* matrix) {
  // Functions are products over the axes, so G G^T is the elementwise product of two small ones.
  column_.resize(m);
  for (std::size_t j = 0; j < m; ++j) {
    Real* column = matrix + packed_column(m, j);
    gram_column(rows_theta_, m, j, column);
    gram_column(rows_gamma_, m, j, column_.data());
    for (std::size_t i = 0; i < m - j; ++i) column[i] *= column_[i];
    if (!penalise_dc_)
      for (std::size_t i = 0; i < m - j; ++i) column[i] -= 1;
    column[0] += penalty;
  }
}

template <class Real>
void RidgeSolver<Real>::primal_matrix(std::size_t m, Real penalty, Real* matrix) const {
  std::fill_n(matrix, packed_size(num_functions_), Real{0});
  std::vector<Real> row(num_functions_);
  for (std::size_t o = 0; o < m; ++o) {
    std::size_t k = 0;
    for (std::size_t b = o; b < rows_gamma_.size(); b += m)
      for (std::size_t a = o; a < rows_theta_.size(); a += m)
        row[k++] = rows_gamma_[b] * rows_theta_[a];
    for (std::size_t j = 0; j < num_functions_; ++j) {
      if (row[j] == 0) continue;
      Real* column = matrix + packed_column(num_functions_, j);
      for (std::size_t i = j; i < num_functions_; ++i) column[i - j] += row[j] * row[i];
    }
  }
  for (std::size_t j = penalise_dc_ ? 0 : 1; j < num_functions_; ++j)
    matrix[packed_column(num_functions_, j)] += penalty;
}

template <class Real>
void RidgeSolver<Real>::solve(const PointObservations& seen, const Real* factor,
                              float* coefficients) {
  const std::size_t m = seen.directions.size();
  std::copy_n(coefficients, model_.size(), model_.begin());
  if (!penalise_dc_) std::fill_n(model_.begin(), 3, Real{0});
  compute_residual(seen);
  if (dual(m)) residual_to_weights(m, factor);
  collect_weights(m);
  if (!dual(m)) solve_primal(factor);
  for (std::size_t i = 0; i < model_.size(); ++i)
    coefficients[i] = static_cast<float>(model_[i] + change_[i]);
  if (dual(m) && !penalise_dc_)
    for (std::size_t c = 0; c < 3; ++c) coefficients[c] = static_cast<float>(dc_[c]);
}

template <class Real>
void RidgeSolver<Real>::compute_residual(const PointObservations& seen) {
  const std::size_t m = seen.directions.size();
  map_.to_nodes(model_.data(), nodes_.data(), scratch_.data());
  taps_.resize(m);
  residual_.resize(m);
  for (std::size_t j = 0; j < m; ++j) {
    taps_[j] = node_taps(basis_, static_cast<double>(seen.directions[j][0]),
                         static_cast<double>(seen.directions[j][1]));
    std::array<Real, 4> r{seen.colours[j][0], seen.colours[j][1], seen.colours[j][2], 0};
    for (std::size_t t = 0; t < taps_[j].count; ++t)
      for (std::size_t c = 0; c < 3; ++c)
        r[c] -= static_cast<Real>(taps_[j].weight[t]) * nodes_[3 * taps_[j].node[t] + c];
    residual_[j].c = r;
  }
}

/// r to z = S^-1 r, and a_0 where it has no penalty.
template <class Real>
void RidgeSolver<Real>::residual_to_weights(std::size_t m, const Real* factor) {
  if (!penalise_dc_) {
    const Real* w = factor + packed_size(m);
    std::array<Real, 4> dc{};
    for (std::size_t j = 0; j < m; ++j)
      for (std::size_t c = 0; c < 4; ++c) dc[c] += w[j] * residual_[j].c[c];
    for (auto& r : residual_)
      for (std::size_t c = 0; c < 4; ++c) r.c[c] -= dc[c];
    std::copy_n(dc.begin(), 3, dc_.begin());
  }
  cholesky_solve(factor, m, residual_.data());
}

/// change_ = G^T z = C^T W^T z.
template <class Real>
void RidgeSolver<Real>::collect_weights(std::size_t m) {
  std::fill(nodes_.begin(), nodes_.end(), Real{0});
  for (std::size_t j = 0; j < m; ++j)
    for (std::size_t t = 0; t < taps_[j].count; ++t)
      for (std::size_t c = 0; c < 3; ++c)
        nodes_[3 * taps_[j].node[t] + c] +=
            static_cast<Real>(taps_[j].weight[t]) * residual_[j].c[c];
  map_.transposed(nodes_.data(), change_.data(), scratch_.data());
}

template <class Real>
void RidgeSolver<Real>::solve_primal(const Real* factor) {
  for (std::size_t k = 0; k < num_functions_; ++k)
    lanes_[k].c = {change_[3 * k], change_[3 * k + 1], change_[3 * k + 2], 0};
  cholesky_solve(factor, num_functions_, lanes_.data());
  for (std::size_t k = 0; k < num_functions_; ++k)
    std::copy_n(lanes_[k].c.begin(), 3, change_.begin() + static_cast<std::ptrdiff_t>(3 * k));
}

template class RidgeSolver<float>;
template class RidgeSolver<double>;

}  // namespace slf
