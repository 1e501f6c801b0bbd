#include "attributes/forward_transform.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "attributes/quantiser.h"

namespace slf {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

}  // namespace

ComponentFinder::ComponentFinder(const ForwardTransform& transform,
                                 std::span<const std::uint32_t> steps)
    : forward_(transform),
      least_step_(static_cast<double>(kCoefficientLimit)),
      values_(transform.inverse.rows() * transform.inverse.lanes),
      components_(transform.inverse.columns() * transform.inverse.lanes) {
  const PlaneTransform& inverse = transform.inverse;
  for (std::size_t c = 0; c < inverse.columns(); ++c)
    for (std::size_t lane = 0; lane < inverse.lanes; ++lane)
      least_step_ = std::min<double>(least_step_, steps[inverse.plane(c) + lane]);
}

void ComponentFinder::find(std::int32_t* row) {
  const PlaneTransform& inverse = forward_.inverse;
  const std::size_t lanes = inverse.lanes;
  std::array<double, 3> energy{};
  for (std::size_t i = 0; i < inverse.rows(); ++i) {
    std::int32_t* value = row + inverse.plane(i);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      double v = value[lane];
      if (lanes == 3) {
        const auto& m = forward_.colour[lane];
        v = m[0] * value[0] + m[1] * value[1] + m[2] * value[2];
      }
      values_[i * lanes + lane] = v;
      energy[lane] += forward_.weights[i] * v * v;
    }
    std::fill_n(value, lanes, 0);
  }
  const double most = std::sqrt(*std::max_element(energy.begin(), energy.end())) * forward_.gain;
  if (most < least_step_ / 2) return;  // most rows
  const Eigen::Map<const Matrix> matrix(forward_.matrix.data(), index(inverse.columns()),
                                        index(inverse.rows()));
  const Eigen::Map<const Matrix> values(values_.data(), index(inverse.rows()), index(lanes));
  Eigen::Map<Matrix>(components_.data(), index(inverse.columns()), index(lanes)).noalias() =
      matrix * values;
  constexpr double kLimit = static_cast<double>(kCoefficientLimit - 1);
  for (std::size_t c = 0; c < inverse.columns(); ++c)
    for (std::size_t lane = 0; lane < lanes; ++lane)
      row[inverse.plane(c) + lane] = static_cast<std::int32_t>(
          std::lround(std::clamp(components_[c * lanes + lane], -kLimit, kLimit)));
}

}  // namespace slf
