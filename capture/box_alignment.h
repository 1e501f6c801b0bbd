// SPDX-License-Identifier: Apache-2.0
// A scale and a shift that bring points to where outlines show the object: boxes upon boxes.
#pragma once

#include <optional>
#include <span>

#include "capture/world_agreement.h"
#include "slf/points_world.h"

namespace slf {

/// The box that most points are in.
struct PointsBox {
  Vec3 centre{0, 0, 0};
  double size = 0;  ///< mean of its sides
};
PointsBox box_of(std::span<const Vec3> points);

/// With another scale, and a point of the cloud where it was.
WorldChange scaled_about(WorldChange change, const Vec3& point, double factor);

/// Nothing where there are no outlines, or cameras do not look at one place.
/// @param axes  scale and shift are found
/// O(points * views).
std::optional<WorldChange> aligned_boxes(std::span<const Vec3> points,
                                         std::span<const WorldView> views,
                                         const std::array<int, 3>& axes);

}  // namespace slf
