// SPDX-License-Identifier: Apache-2.0
// Meshes whose points are too many to be held at once.
#pragma once

#include <functional>

#include "capture/voxelise.h"
#include "slf/capture.h"

namespace slf {

/// voxelise_on(sample_mesh(mesh, grid), grid), voxel by voxel in Morton order, while no more than
/// the points of a cube of 2^kCubeLog2 voxels a side are held.
/// @errors kInvalidInput: the step is too small: faces meet 2^24 of these cubes or more, or have
///         more than 2^24 points in one or 2^30 together
Result<Done, InputError> for_each_mesh_voxel(const Mesh& mesh, const Grid& grid,
                                             const std::function<void(const OccupiedVoxel&)>& take);

inline constexpr int kCubeLog2 = 9;

}  // namespace slf
