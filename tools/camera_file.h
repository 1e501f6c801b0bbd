// SPDX-License-Identifier: Apache-2.0
// Cameras to render from, out of a cameras.json or a capture.
#pragma once

#include <string>

#include "slf/capture.h"
#include "tools/failure.h"

namespace slf::tools {

/// @param reference  FILE, FILE:NAME or FILE:INDEX, where FILE is a cameras.json of the shared
///                   convention (docs/captures.md; no images or points are needed) and NAME an
///                   image of it. FILE alone: its first camera.
/// @errors kInputUnreadable; kInputInvalid: names file, camera and cause.
Result<Camera, Failure> read_camera(const std::string& reference);

/// Camera of the image NAME, or of index NAME, of a capture.
Result<int, Failure> find_camera(const Capture& capture, const std::string& name,
                                 const std::string& file);

/// The same view on an image of another size.
Camera resized(Camera camera, int width, int height);

}  // namespace slf::tools
