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

/// The same behind the capture's mesh or else `occluders`, as observe() has it.
/// @errors kInvalidArgument: a spacing that is not positive
Result<SeenPoints, InputError> observe_behind(const Capture& capture, std::span<const int> cameras,
                                              const ObservedPoints& points,
                                              std::span<const std::array<float, 3>> occluders,
                                              double spacing, const ObserveSettings& settings,
                                              const Progress& progress);

/// What observe() says where no camera sees anything.
InputError nothing_seen(const SightingCounts& counts, std::size_t cameras, std::size_t points);

}  // namespace slf
