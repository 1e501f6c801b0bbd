// SPDX-License-Identifier: Apache-2.0
// The motion between two frames, found from places and colours. Informative.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "geometry/motion.h"

namespace slf {

/// Points of a frame: distinct codes, ascending, and a colour of each, in grey levels.
struct FramePoints {
  std::span<const std::uint64_t> codes;
  std::span<const std::array<float, 3>> colours;
  /// Splats: what is between them is far more than a voxel, and no surface is to be seen.
  bool scattered = false;
};

/// Where the points of `now` were in `before`: an affine motion, one with a lattice added, one with
/// a lattice of half the distance, or none: what foretells places and colours best. Displacements
/// of up to an eighth of the grid are found.
/// @param previous  the motion of the frame before, from where things may go on as they did. Where
///                  it foretells nothing the search begins with none, coarse to fine.
/// The same for any thread count. O(points), and some 25 cells around each of 10,000 of them.
Motion choose_motion(const FramePoints& now, const FramePoints& before, int bits,
                     const Motion& previous);

}  // namespace slf
