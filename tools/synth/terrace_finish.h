// SPDX-License-Identifier: Apache-2.0
// How the surfaces of a terrace look at a place: colour, gloss, and the small relief of stones.
#pragma once

#include "tools/synth/solid.h"
#include "tools/synth/vec.h"

namespace slf::synth {

struct Finish {
  Colour albedo;
  Colour mirror{0, 0, 0};  ///< share of what is reflected sharply, straight on
  double gloss = 0;        ///< the same of what is reflected blurred
  int exponent = 40;       ///< of Blinn-Phong, of the sun in `gloss`
  Vec3 normal;             ///< unit: the surface's, with its relief
};

/// @param footprint  metres that a pixel covers: patterns finer than that are their mean
Finish finish(const Solid& solid, const SurfacePoint& point, double footprint);

}  // namespace slf::synth
