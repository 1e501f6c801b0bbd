// SPDX-License-Identifier: Apache-2.0
// Where training starts when a capture has photographs and cameras, and no points.
#pragma once

#include <span>

#include "slf/capture.h"
#include "slf/error.h"
#include "slf/surface.h"

namespace slf {

struct StartingPoints {
  PointCloud cloud;  ///< with normals
  StartId start = StartId::kHull;
  std::size_t left_out = 0;  ///< of the capture's points: object_points()
};

/// A ball that the cameras look at.
struct LookedAt {
  Vec3 centre{0, 0, 0};
  double radius = 0;
};

/// The point nearest to all axes, and what half of the cameras show of it in full.
/// @errors kInvalidInput: the axes do not meet in front of the cameras (a row of cameras that look
///         the same way, a room from within)
Result<LookedAt, InputError> looked_at(const Capture& capture, std::span<const int> cameras);

/// Whether half of the points lie within a cell of the hull. Then it is a better start than they
/// are where they are few: it has no holes, and its normals are good.
bool lies_on(const PointCloud& hull, const PointCloud& points);

/// The hull where four in five photographs tell the object from the rest, else points of the volume
/// that cameras look at.
/// @param cameras  no other photograph is looked at
/// @errors those of looked_at and load_image
/// The same for any thread count. Time: pixels, and 2 million cells for each camera. Memory: a byte
/// for each pixel.
Result<StartingPoints, InputError> starting_points(const Capture& capture,
                                                   std::span<const int> cameras, int threads);

}  // namespace slf
