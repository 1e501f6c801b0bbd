// SPDX-License-Identifier: Apache-2.0
// The search for a surface on which photographs agree: coarse to fine, a round at each scale.
#pragma once

#include <array>
#include <functional>

#include "encoder/refine/mending_job.h"

namespace slf {

/// Levels of the photographs, a round each (docs/decisions/019).
inline constexpr std::array<int, 4> kMendingLevels{2, 2, 1, 1};

/// All rounds; with fewer points than kLeastMendedPoints it was nothing like a surface.
/// @param bound  whether outlines stay where the photographs have them
/// @param next  called before each round
SurfacePoints mended(const MendingJob& job, bool bound, const std::function<void()>& next);

}  // namespace slf
