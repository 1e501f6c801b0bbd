// SPDX-License-Identifier: Apache-2.0
// Somebody else's Gaussian splats as geometry: the surface that they show.
#pragma once

#include <span>

#include "slf/capture.h"
#include "slf/error.h"
#include "slf/gaussians.h"

namespace slf {

/// Depths at which half of a pixel's light is hidden, in every camera, fused into one layer of
/// points where cameras agree. About as many points as photographs resolve.
/// @param capture  its cameras and photographs; its points are not looked at
/// @param cameras  that look; no other photograph is read
/// @param splats   in the world of the capture's cameras
/// @return positions from capture.origin and outward normals; no colours
/// @errors kInvalidInput: fewer than five cameras or 50 splats, or splats that show no surface;
///         those of check_gaussians() and load_image. Time: cameras (pixels + splats). The same for
///         any thread count.
Result<PointCloud, InputError> surface_of_splats(const Gaussians& splats, const Capture& capture,
                                                 std::span<const int> cameras, int threads = 0);

}  // namespace slf
