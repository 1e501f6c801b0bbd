// SPDX-License-Identifier: Apache-2.0
// Which of the two sides of a surface is the outside, from where it was seen.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "slf/types.h"

namespace slf {

/// Turns each normal, or leaves it, so that it faces the viewpoints that see its point. A point is
/// seen where no other is clearly nearer to the viewpoint in its direction. Where that says little,
/// neighbours that are sure decide.
/// @param neighbours  [P][k] indices of the nearest points
/// The same for any thread count. O(min(viewpoints, 32) P).
void orient_towards(std::span<const std::array<float, 3>> positions,
                    std::span<const Vec3> viewpoints, std::span<const std::uint32_t> neighbours,
                    int threads, std::vector<std::array<float, 3>>& normals);

/// The share of points whose normals face away, 0 .. 1, among those that the viewpoints see clearly
/// from one side. O(min(viewpoints, 32) P).
double share_facing_away(std::span<const std::array<float, 3>> positions,
                         std::span<const Vec3> viewpoints,
                         const std::vector<std::array<float, 3>>& normals, int threads);

/// Away from the centroid: all that can be said without viewpoints.
void orient_outwards(std::span<const std::array<float, 3>> positions,
                     std::vector<std::array<float, 3>>& normals);

}  // namespace slf
