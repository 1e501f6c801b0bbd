// SPDX-License-Identifier: Apache-2.0
// The point cloud of an analytic scene.
#pragma once

#include "slf/capture.h"
#include "tools/synth/scene.h"

namespace slf::synth {

/// Rays along the three axes through a cubic lattice meet the surface; a crossing counts for the
/// axis that its normal is closest to. So a grid as fine as the lattice gets a closed layer of
/// voxels, with hardly any voxel hit twice, and normals and colours are those of the surface
/// itself.
/// @param points  about so many; 0: the scene's default lattice
/// @param step  receives the lattice's, world units
PointCloud sample_points(const Scene& scene, int points, int threads, double* step = nullptr);

}  // namespace slf::synth
