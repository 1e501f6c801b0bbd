// SPDX-License-Identifier: Apache-2.0
// Whether a capture can be meant as it was read. What cannot be used is refused; what is suspicious
// but usable becomes a warning. docs/captures.md lists both.
#pragma once

#include <string>

#include "capture/importer.h"
#include "slf/capture.h"

namespace slf {

/// Sizes, focal lengths, rotation of one.
/// @param label  for messages
Result<Done, InputError> check_camera(const Camera& camera, const std::string& label);

/// Sizes, focal lengths, rotations, distinct names. Warnings go to import.capture.
Result<Done, InputError> check_cameras(Import& import);

/// Whether the cameras look at the cloud. Warnings go to the capture.
/// @param cloud_name  for messages
Result<Done, InputError> check_cloud(Capture& capture, const std::string& cloud_name);

/// The axis that the upper edges of most photographs point to; `otherwise` if none stands out.
UpAxis up_of(const std::vector<Camera>& cameras, UpAxis otherwise);

}  // namespace slf
