// SPDX-License-Identifier: Apache-2.0
// One offset per point from what offsets cost: smooth over the surface; where the photographs
// do not say, as its neighbours.
#pragma once

#include <limits>

#include "encoder/refine/photo_consistency.h"

namespace slf {

/// Limits of one point's offset, world units; least <= most.
struct OffsetLimits {
  float least = std::numeric_limits<float>::lowest();
  float most = std::numeric_limits<float>::max();
};

struct OffsetSettings {
  double smooth = 1.5;  ///< weight of smoothness
  int rounds = 30;      ///< data and smoothness in turns
  int sweeps = 6;       ///< of smoothing in a round
  double tear = 0.03;   ///< how soon neighbours count less, as their offsets (in steps) differ
  int threads = 0;
};

/// @param limits  [P], none is beyond; or empty
/// @return [P] world units
std::vector<float> choose_offsets(const std::vector<float>& costs, const OffsetRange& range,
                                  const SurfaceNeighbours& neighbours,
                                  const OffsetSettings& settings,
                                  std::span<const OffsetLimits> limits = {});

}  // namespace slf
