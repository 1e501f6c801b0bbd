// SPDX-License-Identifier: Apache-2.0
#include "attributes/encoder/forward_transform.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "attributes/quantiser.h"

namespace slf {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

}  // namespace

ComponentFinder::ComponentFinder(const ForwardTransform& transform)
    : forward_(transform),
      values_(transform.inverse.rows() * transform.inverse.lanes),
      components_(transform.inverse.columns() * transform.inverse.lanes) {}

void ComponentFinder::find(const std::int32_t* planes, std::int32_t* components) {
  const PlaneTransform& inverse = forward_.inverse;
  const std::size_t lanes = inverse.lanes, per_function = 3 / lanes;
  for (std::size_t i = 0; i < inverse.functions.size(); ++i) {
    const std::int32_t* value = planes + std::size_t{3} * inverse.functions[i];
    for (std::size_t c = 0; c < 3; ++c) {
      double v = value[c];
      if (lanes == 3) {
        const auto& m = forward_.colour[c];
        v = m[0] * value[0] + m[1] * value[1] + m[2] * value[2];
      }
      values_[3 * i + c] = v;
    }
  }
  const Eigen::Map<const Matrix> matrix(forward_.matrix.data(), index(inverse.columns()),
                                        index(inverse.rows()));
  const Eigen::Map<const Matrix> values(values_.data(), index(inverse.rows()), index(lanes));
  Eigen::Map<Matrix>(components_.data(), index(inverse.columns()), index(lanes)).noalias() =
      matrix * values;
  constexpr double kLimit = static_cast<double>(kCoefficientLimit - 1);
  for (std::size_t c = 0; c < inverse.columns(); ++c) {
    std::int32_t* component =
        components + std::size_t{3} * inverse.components[c / per_function] + c % per_function;
    for (std::size_t lane = 0; lane < lanes; ++lane)
      component[lane] = static_cast<std::int32_t>(
          std::lround(std::clamp(components_[c * lanes + lane], -kLimit, kLimit)));
  }
}

}  // namespace slf
