// SPDX-License-Identifier: Apache-2.0
// What trained surfels show in every photograph, as one surface. Curless, Levoy, "A volumetric
// method for building complex models from range images" (1996).
#pragma once

#include <span>

#include "capture/resample.h"
#include "encoder/train/draw_surfels.h"

namespace slf {

struct FuseSettings {
  double apart = 4;           ///< lattice steps from the surface within which distances are kept
  float least_weight = 0.3f;  ///< views, about: fewer say nothing
  double least_part = 1e-3;   ///< of the points: smaller pieces are debris
  int threads = 0;
};

/// Points at nodes of the lattice, one for each line of it that crosses the surface along the axis
/// that the surface faces most, with outward normals. Lattice::size is not looked at.
/// Empty where the views show no surface. The same for any number of threads.
/// O(views (pixels + nodes near the surface)); memory: 8 bytes a node within `apart`.
SurfacePoints fuse_surfels(const TrainedSurfels& surfels, std::span<const TrainingView> views,
                           const Lattice& lattice, const FuseSettings& settings);

}  // namespace slf
