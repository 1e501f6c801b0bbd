// SPDX-License-Identifier: Apache-2.0
// One voxel of a surface where a dense cloud fills two.
#pragma once

#include "slf/capture.h"

namespace slf {

/// A surface that crosses a grid at a slant touches two voxels of nearly every column, and points
/// that lie closer than voxels fill both. Kept is the one where the surface meets the column's
/// middle, as far as the nearest point to it tells; the column is along the axis that the voxel's
/// normal is closest to. Of voxels in a row on that axis that face the same way, only those go that
/// have a better one beside them.
/// @param cloud   what `voxels` was made from
/// @param voxels  with normals
/// The same on every run. O(P log P).
void thin_layer(const PointCloud& cloud, VoxelCloud& voxels);

}  // namespace slf
