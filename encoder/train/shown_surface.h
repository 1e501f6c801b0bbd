// SPDX-License-Identifier: Apache-2.0
// What trained surfels show in one view: the depth of every pixel, and which way it faces.
#pragma once

#include <vector>

#include "encoder/train/draw_surfels.h"

namespace slf {

struct ShownSurface {
  const TrainingCamera* camera = nullptr;
  SurfelDepths depths;
  std::vector<float> nearest;   ///< [height][width] least depth within kEdgePixels; infinite: none
  std::vector<Float3> normals;  ///< [surfels] towards the camera

  /// World point of a pixel's centre at its depth.
  Float3 point(std::size_t pixel) const;
  const Float3& normal(std::size_t pixel) const { return normals[depths.surfel[pixel]]; }
};

/// So near to an outline a ray does not tell whether it passes.
inline constexpr int kEdgePixels = 2;

ShownSurface shown_surface(const TrainedSurfels& surfels, const TrainingView& view, int threads);

}  // namespace slf
