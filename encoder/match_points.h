// SPDX-License-Identifier: Apache-2.0
// Which point of a frame is which of the frame before. Informative.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/moved_points.h"

namespace slf {

/// Points in Morton order, and what they have.
struct PointValues {
  std::span<const std::uint64_t> codes;  ///< distinct
  std::span<const std::int32_t> values;  ///< [points][planes]
};

/// How every point of `before` goes on: to the point of `now` that is near where the motion takes
/// it and looks like it, one to one; where there is none, as the motion says.
/// @param motion  from places of `before`
/// @param steps   [planes] of the quantiser
/// The same for any thread count. O(points (log points + planes)).
std::vector<PointMove> match_points(const PointValues& now, const PointValues& before,
                                    std::span<const std::uint32_t> steps, const Motion& motion,
                                    int bits, int threads);

}  // namespace slf
