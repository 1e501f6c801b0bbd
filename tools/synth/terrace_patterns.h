// SPDX-License-Identifier: Apache-2.0
// Coordinates on faces, and stones laid in courses.
#pragma once

#include <cstdint>

#include "tools/synth/solid.h"
#include "tools/synth/vec.h"

namespace slf::synth {

/// Metres along a face: v upwards where it is a wall or a roof. Round solids are unrolled.
struct FaceCoordinates {
  double u, v;
};
FaceCoordinates face_coordinates(const Solid& solid, const SurfacePoint& point);

/// 1 where a pixel shows a pattern of that size, 0 where it covers all of it.
double shown(double size, double footprint);

/// Stones of so many metres; each course is shifted by that share of one.
struct Bond {
  double width, height, shift;
};

/// A stone, and where in it a point is.
struct Cell {
  std::uint32_t bits;           ///< random, of the stone
  double edge;                  ///< metres to the nearest edge
  double above;                 ///< metres above the lower edge
  double towards_u, towards_v;  ///< -1, 0, +1: to that edge
};
Cell bond(const FaceCoordinates& at, const Bond& stones, std::uint32_t seed);

}  // namespace slf::synth
