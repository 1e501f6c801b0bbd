// SPDX-License-Identifier: Apache-2.0
// Frames of a moving scene as clouds of views on one grid.
#pragma once

#include "slf/plenoptic.h"
#include "tools/synth/moving_cloud.h"

namespace slf::synth {

/// The voxels of voxel_frame(), with the colours that so many views around have of them and their
/// mean, and noise of one grey level, anew in every frame. A view that a voxel turns away from has
/// the mean of those that see it.
/// The same for any number of threads. O(samples (log samples + views)).
PlenopticCloud voxel_views(const MovingScene& scene, const FrameGrid& grid,
                           const std::vector<MaterialSample>& samples, int frame, int views,
                           int threads);

}  // namespace slf::synth
