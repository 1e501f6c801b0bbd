// SPDX-License-Identifier: Apache-2.0
// The cloud or mesh of a capture, once its cameras and photographs are known.
#pragma once

#include <string>

#include "capture/importer.h"
#include "slf/capture.h"

namespace slf {

/// Reads it from where the options, the format or the folder has it, checks it, and warns of what
/// is suspicious. No points, where that is allowed: a warning, or of an empty PLY nothing.
/// @param path  the capture's, for messages
Result<Done, InputError> load_geometry(const std::string& path, const CaptureOptions& options,
                                       Import& import);

}  // namespace slf
