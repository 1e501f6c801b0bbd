// SPDX-License-Identifier: Apache-2.0
// The motion between two frames, found from places and colours. Informative.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/motion.h"

namespace slf {

/// Points of a frame: distinct codes, ascending, and a colour of each, in grey levels.
struct FramePoints {
  std::span<const std::uint64_t> codes;
  std::span<const std::array<float, 3>> colours;
};

/// Where the points of `now` were in `before`: an affine motion, then with a lattice added, then
/// with one of half the distance. Coarse to fine, the nearest in place and colour. Displacements of
/// up to an eighth of the grid are found. None where a frame has no points.
/// The same for any thread count. O(points), 125 cells around each of 20,000 of them.
std::vector<Motion> find_motions(const FramePoints& now, const FramePoints& before, int bits);

/// One of these, or none: what foretells places and colours best. Informative.
Motion choose_motion(const FramePoints& now, const FramePoints& before, int bits);

}  // namespace slf
