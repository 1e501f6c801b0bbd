// SPDX-License-Identifier: Apache-2.0
// Normals of the surface that voxels lie on, from the voxels alone. Spec 6.6.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "slf/types.h"

namespace slf {

/// Cells at most so far (squared, in cells) from a point's own decide on its normal.
inline constexpr int kNormalRadiusSquared = 16;

/// A vector along the normal of every point, of either sign, exact integers below 2^60, in two
/// steps. The normal of the plane through the cells around its own, each at the mean of its points:
/// the column of the adjugate of their covariance whose diagonal element is largest (the
/// eigenvector of least variance is the dominant one of the adjugate); (0, 0, 1) where that is
/// zero. Then the mean of those of the same cells, which evens out the steps of the grid that a
/// plane follows. Points of a cell have the same normal.
/// @param positions  Morton order, distinct
/// @param cell_log2  side of a cell in voxels, 0 .. 20; as wide as points are apart
/// O(P), some 30 bytes a point besides the result; the same for any thread count.
std::vector<std::array<std::int64_t, 3>> surface_normals(std::span<const Voxel> positions,
                                                         int cell_log2, int threads);

/// The cell_log2 for points as far apart as these.
/// @param positions  as above
int cell_of_spacing(std::span<const Voxel> positions);

}  // namespace slf
