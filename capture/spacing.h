// SPDX-License-Identifier: Apache-2.0
// How far apart the points of a surface lie.
#pragma once

#include <array>
#include <span>

namespace slf {

/// Mean distance to the fourth nearest other point, over up to 2000 points spread evenly: the
/// spacing a grid of the same density would have along its axes. World units; 0 for fewer than two
/// points.
double typical_spacing(std::span<const std::array<float, 3>> points);

}  // namespace slf
