// SPDX-License-Identifier: Apache-2.0
// The steps of voxelise, for geometry that is sampled on the grid itself.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "slf/capture.h"

namespace slf {

struct Box {
  Vec3 min{}, max{};

  double largest_extent() const {
    return std::max({max[0] - min[0], max[1] - min[1], max[2] - min[2]});
  }
};

/// The grid of voxelise. Its origin is box.min.
/// @param points  how many there are: a single one may have no extent
/// @errors kInvalidInput: as voxelise
Result<Grid, InputError> choose_grid(const Box& box, std::size_t points, int bits,
                                     double voxel_size);

/// The grid of a cloud, from its origin. Errors as voxelise.
Result<Grid, InputError> grid_of(const PointCloud& cloud, int bits, double voxel_size);

/// A voxel that has points: means of theirs.
struct OccupiedVoxel {
  std::uint64_t code = 0;         ///< Morton
  std::array<float, 3> normal{};  ///< where the cloud has normals
  std::array<float, 3> colour{};  ///< where it has colours, 0 .. 255
};

/// Where a point is on the grid; outside of it the nearest voxel of its border.
/// @param at  from the grid's origin's own
Voxel voxel_at(const std::array<float, 3>& at, const Grid& grid);

/// The voxels of a cloud in Morton order, without holding them: 16 bytes a point beside the cloud.
/// Points outside the grid are moved to its border.
/// @param grid  from the cloud's origin
void for_each_voxel(const PointCloud& cloud, const Grid& grid,
                    const std::function<void(const OccupiedVoxel&)>& take);

/// The same, all of them.
VoxelCloud voxelise_on(const PointCloud& cloud, const Grid& grid);

}  // namespace slf
