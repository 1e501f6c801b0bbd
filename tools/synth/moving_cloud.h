// SPDX-License-Identifier: Apache-2.0
// Frames of a moving scene as clouds on one grid, to compare codecs with.
#pragma once

#include "tools/synth/moving_frame.h"

namespace slf::synth {

/// The grid of all frames: 2^bits voxels a side around the scene's sphere.
struct FrameGrid {
  double low, step;  ///< the same for all axes
  int bits;          ///< 5 .. 12
};

FrameGrid frame_grid(const MovingScene& scene, int bits);

/// The voxel that a sample is in: z, y, x from the most significant bits, 21 each.
/// @param number  of the sample, for the noise of the scene
std::uint64_t voxel_of(const MovingScene& scene, const FrameGrid& grid,
                       const MaterialSample& sample, int frame, std::uint32_t number);

/// Voxels that samples are in, in the order of z, y, x: whole numbers, one colour, no normals. The
/// colour is the mean of the samples', as a standing eye sees them under standing lamps.
/// The same for any number of threads. O(samples log samples).
PointCloud voxel_frame(const MovingScene& scene, const FrameGrid& grid,
                       const std::vector<MaterialSample>& samples, int frame, int threads);

}  // namespace slf::synth
