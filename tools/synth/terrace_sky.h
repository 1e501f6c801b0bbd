// SPDX-License-Identifier: Apache-2.0
// The sky over a terrace, and its sun.
#pragma once

#include "tools/synth/vec.h"

namespace slf::synth {

/// Towards the sun (unit): late in the afternoon, a third along the street.
Vec3 to_sun();
inline constexpr Colour kSunlight{2.55, 2.2, 1.72};  ///< at normal incidence

/// Light from a direction (unit), with clouds and the sun's disc; below the horizon that of ground.
Colour sky(const Vec3& direction);
/// What lies around the terrace as far as one sees, without being of it: fields and woods in haze.
/// @param eye  above the ground; the direction is unit and leads down
Colour country(const Vec3& eye, const Vec3& direction);
/// The sky without clouds and disc, for surfaces that blur what they reflect.
Colour plain_sky(const Vec3& direction);
/// What falls from all of the sky and the ground on a surface that looks to `normal` in the open.
Colour skylight(const Vec3& normal);

}  // namespace slf::synth
