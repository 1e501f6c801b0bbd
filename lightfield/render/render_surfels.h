// SPDX-License-Identifier: Apache-2.0
// Discs from voxels: where no normals are coded, and how large a disc must be.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "slf/types.h"

namespace slf {

/// Discs that together cover the surface the voxels are samples of.
struct Surfels {
  std::vector<std::array<float, 3>> normals;    ///< [P] unit, of either sign; 0 where there are too
                                                ///< few neighbours to tell
  std::vector<float> radii;                     ///< [P] in voxels
  std::vector<float> spacings;                  ///< [P] in voxels; squared, a point's own area
  std::vector<std::array<float, 3>> centroids;  ///< [P] mean of the neighbours, from the voxel's
                                                ///< own centre, in voxels
};

/// Principal components and spacing of the nearest dozens of voxels around every voxel.
/// Morton order makes it quick, but any order is accepted. O(P) for surfaces.
Surfels estimate_surfels(std::span<const Voxel> positions, int threads);

}  // namespace slf
