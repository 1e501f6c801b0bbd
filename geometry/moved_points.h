// SPDX-License-Identifier: Apache-2.0
// Points of a reference that move one by one, to where the points of a frame are. Spec 8.12.7.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/motion.h"

namespace slf {

/// How far from where the motion takes it a point of the reference is now, in voxels.
using PointMove = std::array<std::int32_t, 3>;

/// Where the motion takes a point; that may be beyond the grid.
Voxel carried(const Motion& motion, const Voxel& point, int bits);

/// Points where they are now. Several may share a voxel.
struct MovedPoints {
  std::vector<std::uint64_t> codes;  ///< ascending
  std::vector<std::uint32_t> from;   ///< [codes] number of the point in the reference
};

/// @param codes  of the reference's points, of `bits` levels
/// @param moves  of each. What they take beyond the grid stays at its border
/// O(n log n).
MovedPoints move_points(std::span<const std::uint64_t> codes, std::span<const PointMove> moves,
                        const Motion& motion, int bits);

}  // namespace slf
