// SPDX-License-Identifier: Apache-2.0
// Depths of a pixel's surfels, as far apart as counts.
#pragma once

#include <algorithm>

#include "encoder/train/training_view.h"
#include "lightfield/render/lanes.h"

namespace slf {

/// What lies farther apart than this in depth, pixels, is no farther apart: one surfel far behind
/// would outweigh all that is right.
inline constexpr float kMostApart = 8;

inline float most_near_of(const TrainingCamera& camera) {
  return kMostApart / std::max(camera.fx, camera.fy);
}

/// @param within  receives where it was within the limits
[[gnu::always_inline]] inline void limit_near(float most, Lanes& near, LaneMask& within) {
  within = (near < most) & (near > -most);
  near = near < most ? near : Lanes{} + most;
  near = near > -most ? near : Lanes{} - most;
}

}  // namespace slf
