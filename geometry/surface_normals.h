// Normals of the surface that voxels lie on, from the voxels alone. Spec 6.6.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "slf/types.h"

namespace slf {

/// Points at most so far (squared, in voxels) from a point decide on its normal.
inline constexpr int kNormalRadiusSquared = 16;

/// A vector along the normal of every point, of either sign, exact integers below 2^60, in two
/// steps. The normal of the plane through the points around it: the column of the adjugate of their
/// covariance whose diagonal element is largest (the eigenvector of least variance is the dominant
/// one of the adjugate); (0, 0, 1) where that is zero. Then the mean of those of the same points,
/// which evens out the steps of the grid that a plane follows.
/// @param positions  Morton order, distinct
/// O(P), 12 bytes a point besides the result; the same for any thread count.
std::vector<std::array<std::int64_t, 3>> surface_normals(std::span<const Voxel> positions,
                                                         int threads);

}  // namespace slf
