// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/trained_surfel.h"

namespace slf {
namespace {

constexpr float kFirstThickness = 0.1f;  // of the radius: docs/decisions/051

}  // namespace

SurfelAxes axes_of(const TrainedSurfel& surfel) {
  UnitTurn<float> turn;
  set_unit_turn(&surfel.value[TrainedSurfel::kTurn], turn);
  Three<Float3> axes;
  set_axes(turn, axes);
  return {axes[0], axes[1], axes[2]};
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

void add_turn_gradient(const TrainedSurfel& surfel, const SurfelAxes& axes, float* turn) {
  UnitTurn<float> unit;
  set_unit_turn(&surfel.value[TrainedSurfel::kTurn], unit);
  add_turn_gradient(unit, {axes.first, axes.second, axes.normal}, turn);
}

}  // namespace slf
