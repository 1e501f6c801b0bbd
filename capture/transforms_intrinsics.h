// SPDX-License-Identifier: Apache-2.0
// The intrinsics of a frame of transforms.json.
#pragma once

#include "capture/image_formats.h"
#include "capture/json.h"

namespace slf {

/// Focal lengths, principal point and distortion from a frame and the document around it; what the
/// frame says overrides the document. Width and height of `camera` are set already. Radial terms k3
/// and k4 become the k1 and k2 that come nearest within the picture (set_radial).
/// @param worst  receives the largest miss of these, in pixels, of several calls
/// @errors kInvalidInput: a fisheye or other model that is not supported (named), no focal length,
///         k3 or k4 that k1 and k2 do not express
Result<Done, InputError> read_transforms_intrinsics(const JsonView& frame, const JsonView& document,
                                                    Camera& camera, double& worst);

/// w and h, if there are any; they may stand in the frame or in the document.
Result<std::optional<ImageSize>, InputError> read_transforms_size(const JsonView& frame,
                                                                  const JsonView& document);

}  // namespace slf
