// SPDX-License-Identifier: Apache-2.0
// Points between the points of a cloud.
#pragma once

#include "slf/capture.h"
#include "slf/types.h"

namespace slf {

/// The smooth surface through a cloud, one point at every voxel of the grid that it passes. Holes
/// of more than one and a half spacings stay open, and so do rims where they are.
/// @param cloud  with normals
/// @param spacing  Density::spacing of it, world units
/// @return colours are those of the nearest point
/// The same for any thread count. O(voxels looked at, some (spacing / step + 2)^2 a point, log P)
PointCloud densify(const PointCloud& cloud, double spacing, const Grid& grid, int threads);

/// Whether the points lie on a surface, evenly: what lies between them can be told. Clouds of
/// structure from motion do not.
bool on_even_surface(const PointCloud& cloud, double spacing);

}  // namespace slf
