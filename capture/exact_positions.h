// SPDX-License-Identifier: Apache-2.0
// From the doubles of a file to the floats of a cloud.
#pragma once

#include <span>

#include "slf/capture.h"

namespace slf {

/// Sets positions and origin. The origin is {0, 0, 0} unless floats would lose more than 1e-7 of
/// the extent; then a corner below all points, a multiple of a power of two below the extent, so
/// that differences to it are exact and whole numbers stay whole.
/// @param exact  what is not finite as a float stays so, for the caller to refuse
void set_positions(std::span<const Vec3> exact, PointCloud& cloud);

}  // namespace slf
