// SPDX-License-Identifier: Apache-2.0
#include "lightfield/render/gaussian_cloud.h"

#include <algorithm>
#include <cmath>

#include "base/quaternion.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kShapesPerRange = 4096;
constexpr double kShownDeviations = 3;
constexpr double kNearestShare = 0.02;  // of the radius of a scene that is smaller than usual

/// R S S R^T of a unit quaternion and deviations.
std::array<float, 6> covariance_of(const std::array<float, 4>& q,
                                   const std::array<float, 3>& log_deviations) {
  Matrix3x3 m = rotation_of(q);
  for (std::size_t k = 0; k < 3; ++k) {
    const double deviation = std::exp(double{log_deviations[k]});
    for (auto& row : m) row[k] *= deviation;
  }
  const auto product = [&](std::size_t i, std::size_t j) {
    return static_cast<float>(m[i][0] * m[j][0] + m[i][1] * m[j][1] + m[i][2] * m[j][2]);
  };
  return {product(0, 0), product(0, 1), product(0, 2), product(1, 1), product(1, 2), product(2, 2)};
}

GaussianShape shape_of(const Gaussians& gaussians, std::size_t p) {
  GaussianShape shape;
  shape.covariance = covariance_of(gaussians.rotations[p], gaussians.log_deviations[p]);
  shape.opacity = 1 / (1 + std::exp(-gaussians.logits[p]));
  // At the centre alpha is capped, but the flanks of an opaque splat are not.
  shape.reach = 2 * std::log(shape.opacity / GaussianKernel::least_alpha);
  return shape;
}

}  // namespace

GaussianCloud gaussian_cloud(const Gaussians& gaussians, int threads) {
  GaussianCloud cloud;
  cloud.shapes.resize(gaussians.size());
  parallel_ranges(gaussians.size(), kShapesPerRange, threads,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t p = begin; p < end; ++p)
                      cloud.shapes[p] = shape_of(gaussians, p);
                  });
  cloud.ball = framed_ball(gaussians.positions);
  if (cloud.ball.radius > 0)
    cloud.nearest = std::min(cloud.nearest, kNearestShare * cloud.ball.radius);
  else  // in one place: as far as the greatest reaches
    for (const std::array<float, 3>& log : gaussians.log_deviations)
      cloud.ball.radius =
          std::max(cloud.ball.radius,
                   kShownDeviations * std::exp(double{std::max({log[0], log[1], log[2]})}));
  return cloud;
}

}  // namespace slf
