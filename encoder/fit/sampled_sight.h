// SPDX-License-Identifier: Apache-2.0
// What photographs show of a sample of the points, before anything is made of them.
#pragma once

#include <span>

#include "slf/camera_trust.h"
#include "slf/capture.h"
#include "slf/fit.h"

namespace slf {

/// Looks at some 30,000 of a cloud's points in every photograph, of a megapixel at most.
/// @param cloud  from the capture's origin
/// @return points in Morton order; none where there are none, or all are in one place
/// @errors those of observe, but for points that nobody sees
/// The same for any thread count.
Result<Observations, InputError> sampled_sight(const Capture& capture, const PointCloud& cloud,
                                               std::span<const int> cameras, int threads);

/// Photographs of something else or from a wrong pose, by a sample of the points: check_cameras
/// without its gains. What is trained would take such pictures in. None where they agree nowhere,
/// since then the points may be at fault, and where points are too few to tell.
/// @param cloud  in place of the capture's
/// @errors as sampled_sight
Result<std::vector<CameraTrust>, InputError> foreign_photographs(const Capture& capture,
                                                                 const PointCloud& cloud,
                                                                 std::span<const int> cameras,
                                                                 int threads);

}  // namespace slf
