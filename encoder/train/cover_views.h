// SPDX-License-Identifier: Apache-2.0
// A fused surface against what each view shows: points where it is missing (outlines that averages
// have worn off, hollows that few views see), and none where no view shows it.
#pragma once

#include <span>

#include "encoder/train/distance_blocks.h"
#include "encoder/train/shown_surface.h"

namespace slf {

/// Adds the node nearest to what a view shows at each pixel where the points are not, or lie far
/// behind, unless other views look through it; view by view, so that none is added twice. Removes
/// the points that are nowhere what a view shows: inner sides of averages.
/// @param distances  those that the points were found in
void cover_views(const TrainedSurfels& surfels, std::span<const TrainingView> views,
                 const DistanceBlocks& distances, double apart, int threads, SurfacePoints& points);

}  // namespace slf
