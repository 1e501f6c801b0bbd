// SPDX-License-Identifier: Apache-2.0
// Which side of a mesh is its outside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "slf/capture.h"

namespace slf {

/// Points that cameras see in front of all others, counted once for each.
struct Sides {
  std::size_t towards = 0, away = 0;  ///< the camera, by their normals
};

/// @param tolerance  depth behind the foremost that still counts as in front
Sides sides_in_front(const std::vector<Camera>& cameras, const PointCloud& points,
                     double tolerance);

/// What normals of a cloud were, before they were turned.
enum class GivenNormals : std::uint8_t { kOutwards, kInwards, kEitherWay };

/// Turns the normals of a cloud to where cameras see them from: all, where most of the points in
/// front face away; each for itself, where many do.
GivenNormals turn_towards(const std::vector<Camera>& cameras, PointCloud& cloud);

/// Turns all faces and normals where most of what the cameras see first faces away from them.
/// @return whether it did
bool turn_towards(const std::vector<Camera>& cameras, Mesh& mesh);

}  // namespace slf
