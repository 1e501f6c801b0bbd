// SPDX-License-Identifier: Apache-2.0
// Clouds that are wrong on purpose: what a scanner's noise and a visual hull do to geometry.
#pragma once

#include <cstdint>

#include "slf/capture.h"

namespace slf::synth {

struct DisturbSettings {
  double noise = 0;        ///< standard deviation along the normal, in point spacings, 0 .. 10
  double noise_scale = 0;  ///< over how many spacings it is the same; 0: each point by itself
  double hull = 0;         ///< most that points are pushed outwards, in spacings, 0 .. 20
  std::uint64_t seed = 1;

  bool any() const { return noise > 0 || hull > 0; }
};

/// Moves points along their normals. The hull's push varies slowly (over about 30 spacings) between
/// none and `hull`. Normals are dropped, as nobody would know them. The same for the same settings.
/// @param spacing  between neighbouring points, world units
void disturb(PointCloud& cloud, double spacing, const DisturbSettings& settings);

}  // namespace slf::synth
