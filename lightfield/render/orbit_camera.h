// SPDX-License-Identifier: Apache-2.0
// Cameras on a circle around what has to be shown.
#pragma once

#include "lightfield/render/framed_ball.h"
#include "slf/capture.h"

namespace slf {

struct OrbitView {
  double turn = 0;               ///< 0 .. 1
  double elevation_degrees = 0;  ///< above the plane across the up axis
  int width = 0, height = 0;
  double fov_degrees = 30;  ///< of the shorter side
};

/// Looks at the centre of the ball, which fits into the image with a margin of 3 %. An unknown axis
/// counts as +z.
Camera orbit_camera(const FramedBall& ball, UpAxis up, const OrbitView& view);

}  // namespace slf
