// SPDX-License-Identifier: Apache-2.0
// Brings points inside of the object's outlines, where photographs have them.
#pragma once

#include <vector>

#include "capture/surface_points.h"
#include "encoder/measure/outlines.h"

namespace slf {

/// Moves points that lie outside of the hull inwards along their normals, to its surface. Points
/// that `farthest` does not bring inside are left out.
/// @param half_side  world units: so near to an outline a point is inside
/// The same for any thread count. O(points * outlines).
void carve(SurfacePoints& surface, const std::vector<Outline>& outlines, double half_side,
           double farthest, int threads);

}  // namespace slf
