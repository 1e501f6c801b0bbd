// SPDX-License-Identifier: Apache-2.0
// The values of a reference whose points have moved one by one, at every level. Spec 8.12.7.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "attributes/reference_means.h"
#include "geometry/moved_points.h"

namespace slf {

/// Means of the points in every node of a level, from the root to `bits`.
/// @param values  [points of the reference][planes] at most 2^17 in magnitude
/// O(points * bits * planes).
LevelMeans moved_means(const MovedPoints& moved, std::span<const std::int32_t> values,
                       std::size_t planes, int bits);

}  // namespace slf
