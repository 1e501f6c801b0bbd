// SPDX-License-Identifier: Apache-2.0
// How much brighter one photograph is than another where both see the same points.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "slf/fit.h"

namespace slf {

/// Two cameras that see points from nearly the same direction.
struct ExposurePair {
  std::uint32_t a = 0, b = 0;         ///< cameras, a < b
  std::array<double, 3> log_ratio{};  ///< median over points of log(value in b / value in a)
  double weight = 0;                  ///< 0 .. 1: less of few points, of points that disagree, and
                                      ///< of directions far apart
};

/// Compares every view of a point with those nearest in direction. Values that are dark or clipped
/// do not count.
/// @return pairs with 12 points or more, by a, then b
/// O(squared views of each point).
std::vector<ExposurePair> exposure_pairs(const Observations& seen);

}  // namespace slf
