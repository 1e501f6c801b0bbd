// SPDX-License-Identifier: Apache-2.0
// One surfel in one picture, with what its gradients need again.
#pragma once

#include <optional>

#include "encoder/train/draw_surfels.h"

namespace slf {

/// @f[ Q = A A^T + filter^2 I @f] with A the radii in pixels; Zwicker et al. (2002).
struct SurfelProjection {
  Float3 at{};                                 ///< of the centre, in the camera
  SurfelAxes axes;                             ///< in the world
  std::array<float, 3> radius{};               ///< a disc's third is 0
  std::array<Float3, 2> jacobian{};            ///< rows of d(u, v) / d(camera)
  std::array<float, 2> slope{};                ///< x / z and y / z as the Jacobian has them
  std::array<bool, 2> clamped{};               ///< they are not those of `at`
  std::array<std::array<float, 2>, 3> across;  ///< [axis][u, v] A
  Float3 normal{};                             ///< in the camera
  float plane = 0;                             ///< normal . at, kept off 0
  bool grazing = false;                        ///< it was
  Float3 direction{};                          ///< from the camera's centre, unit
  float distance = 0;
  ProjectedSurfel projected;
};

/// Nothing where no pixel can show it.
std::optional<SurfelProjection> project_surfel(const TrainedSurfel& surfel,
                                               const TrainingCamera& camera);

/// Chain rule through project_surfel.
void add_projection_gradient(const TrainedSurfel& surfel, const TrainingCamera& camera,
                             const SurfelProjection& projection, const ProjectedGradient& gradient,
                             TrainedSurfel& sum);

}  // namespace slf
