// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/direction_rows.h"

#include <bit>
#include <cmath>

#include "lightfield/basis.h"
#include "lightfield/directions.h"
#include "slf/view_map.h"

namespace slf {
namespace {

/// 0 for the constant, k + 1 for a wavelet of scale k.
int scale_of(unsigned index) { return static_cast<int>(std::bit_width(index)); }

}  // namespace

DirectionRows::DirectionRows(const Basis& basis)
    : basis_(basis),
      harmonics_(basis.id == BasisId::kHarmonics ? basis.degree : 0),
      theta_(basis.order, basis.scales_theta),
      gamma_(basis.order, basis.scales_gamma),
      norms_(basis_norms(basis)) {
  for (int k = 0; k < basis.num_functions(); ++k) {
    if (basis.id == BasisId::kHarmonics) {
      fineness_.push_back(static_cast<int>(std::sqrt(k)));
    } else {
      const auto i = static_cast<unsigned>(k);
      fineness_.push_back(scale_of(i & ((1u << basis.scales_theta) - 1)) +
                          scale_of(i >> basis.scales_theta));
    }
  }
}

void DirectionRows::evaluate(const std::array<float, 2>& direction, float* row) const {
  if (basis_.id == BasisId::kHarmonics) {
    harmonics_.evaluate(vector_of(direction), row);
    return;
  }
  std::array<float, 64> theta, gamma;  // 2^6 functions at most
  theta_.evaluate(axis_of_theta(static_cast<double>(direction[0])), theta.data());
  gamma_.evaluate(axis_of_gamma(static_cast<double>(direction[1])), gamma.data());
  std::size_t k = 0;
  for (int i1 = 0; i1 < gamma_.size(); ++i1)
    for (int i0 = 0; i0 < theta_.size(); ++i0, ++k)
      row[k] = gamma[static_cast<std::size_t>(i1)] * theta[static_cast<std::size_t>(i0)] /
               static_cast<float>(norms_[k]);
}

void DirectionRows::evaluate(std::span<const Vec3> directions, float* rows) const {
  if (basis_.id == BasisId::kHarmonics) return harmonics_.evaluate(directions, rows);
  for (std::size_t i = 0; i < directions.size(); ++i)
    evaluate(direction_of(directions[i]), rows + i * size());
}

void DirectionRows::evaluate_columns(std::span<const std::array<float, 2>> directions,
                                     float* columns, std::size_t stride) const {
  if (basis_.id == BasisId::kHarmonics) {
    std::vector<Vec3> vectors;
    vectors.reserve(directions.size());
    for (const auto& d : directions) vectors.push_back(vector_of(d));
    harmonics_.evaluate_columns(vectors, columns, stride);
    return;
  }
  std::vector<float> row(size());
  for (std::size_t i = 0; i < stride; ++i) {
    if (i < directions.size()) evaluate(directions[i], row.data());
    for (std::size_t k = 0; k < row.size(); ++k) columns[k * stride + i] = row[k];
  }
}

}  // namespace slf
