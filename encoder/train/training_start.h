// SPDX-License-Identifier: Apache-2.0
// What every training begins with: photographs, points, and how many surfels.
#pragma once

#include <span>
#include <vector>

#include "encoder/train/train_geometry.h"
#include "encoder/train/train_surfels.h"

namespace slf {

struct TrainingStart {
  SurfacePoints points;
  double spacing = 0;
  std::vector<TrainingView> views;  ///< empty: the points have no spacing
  TrainSettings settings;
};

/// @errors those of load_image
Result<TrainingStart, InputError> training_start(const Capture& capture,
                                                 std::span<const int> cameras,
                                                 const TrainGeometrySettings& settings,
                                                 const Progress& progress);

TrainedSurfels first_surfels(const TrainingStart& start, const TrainGeometrySettings& settings);

}  // namespace slf
