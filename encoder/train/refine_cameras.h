// SPDX-License-Identifier: Apache-2.0
// Poses that photographs agree on, by a training of splats in which cameras move as well.
#pragma once

#include <span>

#include "encoder/train/train_geometry.h"
#include "slf/camera_poses.h"

namespace slf {

/// Trains splats and poses together, and gives up the splats. All cameras have one mean motion of
/// none, so the scene stays where it is.
/// @errors those of load_image; of a checkpoint
/// The same for any number of threads. Time: that of a training.
Result<PoseReport, InputError> refine_cameras(const Capture& capture, std::span<const int> cameras,
                                              TrainGeometrySettings settings,
                                              const Progress& progress);

}  // namespace slf
