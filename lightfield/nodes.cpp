// SPDX-License-Identifier: Apache-2.0
#include "lightfield/nodes.h"

#include <algorithm>

namespace slf {
namespace {

template <class Real>
std::vector<Real> axis_matrix(int order, int scales) {
  const AxisTable table(order, scales);
  std::vector<Real> matrix;
  for (int i = 0; i < table.size(); ++i)
    for (int j = 0; j < table.size(); ++j)
      matrix.push_back(static_cast<Real>(table.coefficient(i, j)));
  return matrix;
}

template <class Real>
void add_scaled(Real* sum, const Real* values, Real factor, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) sum[i] += factor * values[i];
}

template <class Real>
bool all_zero(const Real* values, std::size_t size) {
  return std::all_of(values, values + size, [](Real v) { return v == 0; });
}

/// [rows][columns][3] to [columns][rows][3].
template <class Real>
void transpose_triples(const Real* from, std::size_t rows, std::size_t columns, Real* to) {
  for (std::size_t c = 0; c < columns; ++c)
    for (std::size_t r = 0; r < rows; ++r, to += 3) {
      const Real* triple = from + 3 * (r * columns + c);
      to[0] = triple[0];
      to[1] = triple[1];
      to[2] = triple[2];
    }
}

}  // namespace

NodeTaps node_taps(const Basis& basis, double theta, double gamma) {
  const int size_theta = 1 << basis.scales_theta, size_gamma = 1 << basis.scales_gamma;
  const SplineTaps a = spline_taps(basis.order, size_theta, axis_of_theta(theta));
  const SplineTaps b = spline_taps(basis.order, size_gamma, axis_of_gamma(gamma));
  NodeTaps taps;
  for (std::size_t i = 0; i < static_cast<std::size_t>(basis.order); ++i)
    for (std::size_t j = 0; j < static_cast<std::size_t>(basis.order); ++j) {
      taps.node[taps.count] = static_cast<std::size_t>(a.index[i] * size_gamma + b.index[j]);
      taps.weight[taps.count++] = a.weight[i] * b.weight[j];
    }
  return taps;
}

template <class Real>
NodeMap<Real>::NodeMap(const Basis& basis)
    : size_theta_(std::size_t{1} << basis.scales_theta),
      size_gamma_(std::size_t{1} << basis.scales_gamma),
      theta_(axis_matrix<Real>(basis.order, basis.scales_theta)),
      gamma_(axis_matrix<Real>(basis.order, basis.scales_gamma)) {}

template <class Real>
void NodeMap<Real>::to_nodes(const Real* coefficients, Real* nodes, Real* scratch) const {
  // Along gamma in `nodes`, whole rows at a time; turned in `scratch`; then along theta.
  const std::size_t row = 3 * size_theta_, column = 3 * size_gamma_;
  std::fill_n(nodes, size(), Real{0});
  for (std::size_t i = 0; i < size_gamma_; ++i) {
    if (all_zero(coefficients + i * row, row)) continue;
    for (std::size_t j = 0; j < size_gamma_; ++j)
      if (const Real factor = gamma_[i * size_gamma_ + j]; factor != 0)
        add_scaled(nodes + j * row, coefficients + i * row, factor, row);
  }
  transpose_triples(nodes, size_gamma_, size_theta_, scratch);
  std::fill_n(nodes, size(), Real{0});
  for (std::size_t i = 0; i < size_theta_; ++i) {
    if (all_zero(scratch + i * column, column)) continue;
    for (std::size_t j = 0; j < size_theta_; ++j)
      if (const Real factor = theta_[i * size_theta_ + j]; factor != 0)
        add_scaled(nodes + j * column, scratch + i * column, factor, column);
  }
}

template <class Real>
void NodeMap<Real>::transposed(const Real* nodes, Real* coefficients, Real* scratch) const {
  const std::size_t row = 3 * size_theta_, column = 3 * size_gamma_;
  std::fill_n(coefficients, size(), Real{0});
  for (std::size_t i = 0; i < size_theta_; ++i)
    for (std::size_t j = 0; j < size_theta_; ++j)
      if (const Real factor = theta_[i * size_theta_ + j]; factor != 0)
        add_scaled(coefficients + i * column, nodes + j * column, factor, column);
  transpose_triples(coefficients, size_theta_, size_gamma_, scratch);
  std::fill_n(coefficients, size(), Real{0});
  for (std::size_t i = 0; i < size_gamma_; ++i)
    for (std::size_t j = 0; j < size_gamma_; ++j)
      if (const Real factor = gamma_[i * size_gamma_ + j]; factor != 0)
        add_scaled(coefficients + i * row, scratch + j * row, factor, row);
}

template class NodeMap<float>;
template class NodeMap<double>;

}  // namespace slf
