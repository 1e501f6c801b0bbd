// SPDX-License-Identifier: Apache-2.0
// From where coordinates are given as floats.
#pragma once

#include <algorithm>
#include <cmath>

#include "slf/types.h"

namespace slf {

/// 0, or the middle of the grid where floats of the world's coordinates are more than 1/8 voxel off
/// and those from the middle are finer. The same for all that is on the grid.
inline Vec3 float_origin(const Grid& grid) {
  constexpr double kFarthest = 1 << 19;  // voxels: floats have 24 bits
  constexpr double kFiner = 4;
  const double half = std::ldexp(grid.step, grid.bits - 1);
  Vec3 middle{};
  double farthest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    middle[k] = grid.origin[k] + half;
    farthest = std::max(farthest, std::abs(middle[k]) + half);
  }
  if (farthest <= kFarthest * grid.step || farthest <= kFiner * half) return {0, 0, 0};
  return middle;
}

}  // namespace slf
