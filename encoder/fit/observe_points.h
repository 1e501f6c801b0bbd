// SPDX-License-Identifier: Apache-2.0
// What cameras see of points, where something else says what hides them.
#pragma once

#include <functional>
#include <span>

#include "encoder/fit/observe_camera.h"
#include "encoder/fit/observe_depth.h"
#include "slf/fit.h"

namespace slf {

/// The depth buffer of a camera of the capture. Called from several threads at once.
using DepthOfCamera = std::function<Result<DepthBuffer, InputError>(int camera)>;

struct SeenPoints {
  Observations observations;  ///< perhaps none
  SightingCounts counts;
};

/// observe() without its occluders: that no camera sees anything is no error.
/// @errors those of load_image and of depth_of
Result<SeenPoints, InputError> observe_points(const Capture& capture, std::span<const int> cameras,
                                              const ObservedPoints& points,
                                              const DepthOfCamera& depth_of,
                                              const ObserveSettings& settings,
                                              const Progress& progress = {});

}  // namespace slf
