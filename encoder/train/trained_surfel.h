// SPDX-License-Identifier: Apache-2.0
// A surfel in training: a flat disc with a soft edge, or an ellipsoid, an opacity and a colour that
// depends on direction. Huang, Yu, Chen, Geiger, Gao, "2D Gaussian Splatting" (2024), with the edge
// of the reference kernel in place of a Gaussian.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "capture/surface_points.h"
#include "encoder/train/surfel_functions.h"

namespace slf {

/// All that is learnt of a surfel, as one row: an optimiser does not tell its parts apart.
struct TrainedSurfel {
  static constexpr std::size_t kPosition = 0;   ///< 3: world
  static constexpr std::size_t kTurn = 3;       ///< 4: quaternion w, x, y, z of any length; its
                                                ///< third axis is the normal
  static constexpr std::size_t kLogRadius = 7;  ///< 3: of the world radii along the axes, where the
                                                ///< kernel ends; a disc has no use for the third
  static constexpr std::size_t kOpacity = 10;   ///< 1: its logit
  static constexpr std::size_t kColour = 11;    ///< [functions][3], R, G, B in 0 .. 1
  static constexpr std::size_t kSize = kColour + 3 * kTrainedFunctions;

  std::array<float, kSize> value{};

  Float3 position() const { return {value[0], value[1], value[2]}; }
  float opacity() const { return 1 / (1 + std::exp(-value[kOpacity])); }
  float radius(std::size_t axis) const { return std::exp(value[kLogRadius + axis]); }
};

using TrainedSurfels = std::vector<TrainedSurfel>;

/// Columns of the rotation of a quaternion, which has any length but 0.
struct SurfelAxes {
  Float3 first, second, normal;
  const Float3& axis(std::size_t k) const { return k == 0 ? first : k == 1 ? second : normal; }
};
SurfelAxes axes_of(const TrainedSurfel& surfel);

/// A surfel that lies in the plane of `normal` (unit), round.
TrainedSurfel flat_surfel(const Float3& position, const Float3& normal, float radius,
                          float opacity);

/// @param axes  gradient with respect to them
/// @param turn  receives what it is with respect to the quaternion
void add_turn_gradient(const TrainedSurfel& surfel, const SurfelAxes& axes, float* turn);

}  // namespace slf
