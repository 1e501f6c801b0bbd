// SPDX-License-Identifier: Apache-2.0
// The search for a surface on which photographs agree: coarse to fine, a round at each scale.
#pragma once

#include <array>
#include <functional>

#include "encoder/refine/mending_job.h"

namespace slf {

/// Levels of the photographs, a round each (docs/decisions/019).
inline constexpr std::array<int, 4> kMendingLevels{2, 2, 1, 1};

/// How a search goes about outlines: free, or held where the photographs have them.
enum class Outlines { kFree, kBound };

/// All rounds; with fewer points than kLeastMendedPoints, or none, it was nothing like a surface.
/// @param next  called before each round
SurfacePoints mended(const MendingJob& job, Outlines outlines, const std::function<void()>& next);

/// The same surface of more points, and photographs of their own size: parts of a pixel.
SurfacePoints polished(const MendingJob& job, const SurfacePoints& surface, Outlines outlines);

}  // namespace slf
