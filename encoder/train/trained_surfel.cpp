// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/trained_surfel.h"

namespace slf {
namespace {

constexpr float kFirstThickness = 0.1f;  // of the radius: docs/decisions/051

// Kerbl et al., "3D Gaussian Splatting" (2023), as their files have it.
constexpr float kLinear = 0.4886025119029199f;
constexpr float kProduct = 1.0925484305920792f;  // of two coordinates
constexpr float kZonal = 0.31539156525252005f, kSectoral = 0.5462742152960396f;
// Degree 3: of orders 3, 2, 1 and 0, and of z (x^2 - y^2).
constexpr float kThird0 = 0.5900435899266435f, kThird1 = 2.890611442640554f,
                kThird2 = 0.4570457994644658f, kThird3 = 0.3731763325901154f,
                kThird4 = 1.445305721320277f;

/// A quaternion of length 1, and one over the length that it had.
struct UnitTurn {
  float w, x, y, z, inverse;
};

UnitTurn unit_turn(const TrainedSurfel& surfel) {
  const float* q = &surfel.value[TrainedSurfel::kTurn];
  const float inverse =
      1 / std::sqrt(std::max(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1e-20f));
  return {q[0] * inverse, q[1] * inverse, q[2] * inverse, q[3] * inverse, inverse};
}

}  // namespace

SurfelAxes axes_of(const TrainedSurfel& surfel) {
  const auto [w, x, y, z, inverse] = unit_turn(surfel);
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
          {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
          {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

TrainedSurfel flat_surfel(const Float3& position, const Float3& normal, float radius,
                          float opacity) {
  TrainedSurfel surfel;
  for (std::size_t a = 0; a < 3; ++a) surfel.value[TrainedSurfel::kPosition + a] = position[a];
  // The turn that takes z to the normal by the shortest way; about x where it points down.
  float* q = &surfel.value[TrainedSurfel::kTurn];
  const float half = 1 + normal[2];
  if (half > 1e-4f) {
    q[0] = half, q[1] = -normal[1], q[2] = normal[0];
    const float length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]);
    for (std::size_t i = 0; i < 3; ++i) q[i] /= length;
  } else {
    q[1] = 1;
  }
  surfel.value[TrainedSurfel::kLogRadius] = surfel.value[TrainedSurfel::kLogRadius + 1] =
      std::log(radius);
  surfel.value[TrainedSurfel::kLogRadius + 2] = std::log(kFirstThickness * radius);
  surfel.value[TrainedSurfel::kOpacity] = std::log(opacity / (1 - opacity));
  return surfel;
}

void add_turn_gradient(const TrainedSurfel& surfel, const SurfelAxes& d, float* turn) {
  const auto [w, x, y, z, inverse] = unit_turn(surfel);
  const Float3 &a = d.first, &b = d.second, &n = d.normal;
  const std::array<float, 4> unit = {
      2 * (z * a[1] - y * a[2] - z * b[0] + x * b[2] + y * n[0] - x * n[1]),
      2 * (y * a[1] + z * a[2] + y * b[0] - 2 * x * b[1] + w * b[2] + z * n[0] - w * n[1] -
           2 * x * n[2]),
      2 * (-2 * y * a[0] + x * a[1] - w * a[2] + x * b[0] + z * b[2] + w * n[0] + z * n[1] -
           2 * y * n[2]),
      2 * (-2 * z * a[0] + w * a[1] + x * a[2] - w * b[0] - 2 * z * b[1] + y * b[2] + x * n[0] +
           y * n[1])};
  const std::array<float, 4> q = {w, x, y, z};
  float along = 0;
  for (std::size_t i = 0; i < 4; ++i) along += q[i] * unit[i];
  for (std::size_t i = 0; i < 4; ++i) turn[i] += inverse * (unit[i] - along * q[i]);
}

std::array<float, kTrainedFunctions> trained_functions(const Float3& d) {
  const auto [x, y, z] = d;
  return {kMeanFunction,
          -kLinear * y,
          kLinear * z,
          -kLinear * x,
          kProduct * x * y,
          -kProduct * y * z,
          kZonal * (2 * z * z - x * x - y * y),
          -kProduct * x * z,
          kSectoral * (x * x - y * y),
          -kThird0 * y * (3 * x * x - y * y),
          kThird1 * x * y * z,
          -kThird2 * y * (4 * z * z - x * x - y * y),
          kThird3 * z * (2 * z * z - 3 * x * x - 3 * y * y),
          -kThird2 * x * (4 * z * z - x * x - y * y),
          kThird4 * z * (x * x - y * y),
          -kThird0 * x * (x * x - 3 * y * y)};
}

Float3 direction_gradient(const Float3& d, const std::array<float, kTrainedFunctions>& g) {
  const auto [x, y, z] = d;
  return {-kLinear * g[3] + kProduct * (y * g[4] - z * g[7]) - 2 * kZonal * x * g[6] +
              2 * kSectoral * x * g[8] -
              kThird0 * (6 * x * y * g[9] + 3 * (x * x - y * y) * g[15]) + kThird1 * y * z * g[10] +
              kThird2 * (2 * x * y * g[11] - (4 * z * z - 3 * x * x - y * y) * g[13]) -
              6 * kThird3 * x * z * g[12] + 2 * kThird4 * x * z * g[14],
          -kLinear * g[1] + kProduct * (x * g[4] - z * g[5]) - 2 * kZonal * y * g[6] -
              2 * kSectoral * y * g[8] -
              kThird0 * (3 * (x * x - y * y) * g[9] - 6 * x * y * g[15]) + kThird1 * x * z * g[10] -
              kThird2 * ((4 * z * z - x * x - 3 * y * y) * g[11] - 2 * x * y * g[13]) -
              6 * kThird3 * y * z * g[12] - 2 * kThird4 * y * z * g[14],
          kLinear * g[2] - kProduct * (y * g[5] + x * g[7]) + 4 * kZonal * z * g[6] +
              kThird1 * x * y * g[10] - 8 * kThird2 * z * (y * g[11] + x * g[13]) +
              3 * kThird3 * (2 * z * z - x * x - y * y) * g[12] +
              kThird4 * (x * x - y * y) * g[14]};
}

}  // namespace slf
