// SPDX-License-Identifier: Apache-2.0
// What a view of a whole light field has to show.
#pragma once

#include <array>
#include <span>

#include "slf/types.h"

namespace slf {

struct FramedBall {
  Vec3 centre{0, 0, 0};
  double radius = 0;
};

/// About the middle of the points' box, in world units. A few points far away, which make the box
/// more than four times as wide as 98 % of them do along every axis, are not in it: structure from
/// motion leaves them. The viewer has the same (web/viewer/packed_field.js).
FramedBall framed_ball(const Grid& grid, std::span<const Voxel> positions);
/// The same of splats, whose positions are finite and not on a grid. Their sky is many: without a
/// tenth of them at either end of each axis the rest has to be wide.
FramedBall framed_ball(std::span<const std::array<float, 3>> positions);

}  // namespace slf
