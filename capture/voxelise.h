// The steps of voxelise, for geometry that is sampled on the grid itself.
#pragma once

#include <algorithm>
#include <cstddef>

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

/// Points outside the grid are moved to its border.
/// @param grid  from the cloud's origin
VoxelCloud voxelise_on(const PointCloud& cloud, const Grid& grid);

}  // namespace slf
