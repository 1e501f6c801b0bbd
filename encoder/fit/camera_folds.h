// SPDX-License-Identifier: Apache-2.0
// Parts of the input cameras to hold out in turn: for cross-validation of what a fit is set to.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "encoder/fit/pointwise_observations.h"
#include "slf/types.h"

namespace slf {

struct CameraFolds {
  int count = 0;               ///< 0 .. 4
  std::size_t cameras = 0;     ///< that see anything
  std::vector<int> of_camera;  ///< [highest camera index + 1] 0 .. count - 1; -1: sees nothing
};

/// [cameras] of 0 .. 3. Cameras close to each other, as seen from the object, are in the same part;
/// so what is held out has no neighbour left.
/// @param groups  of neighbours, 4 to 32: a fifth of the cameras, but so many where two cameras a
///                group are left, so that few cameras are not held out by whole sides
std::vector<int> camera_folds(std::span<const Vec3> towards_camera, std::size_t groups = 4);

/// The same of the cameras of observations, each in the mean direction of its observations.
/// @param normals  those that directions are mirrored at; none: directions of the world
CameraFolds camera_folds(const PointwiseObservations& observations,
                         std::span<const std::array<float, 3>> normals);

}  // namespace slf
