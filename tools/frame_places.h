// SPDX-License-Identifier: Apache-2.0
// Options that name a file or a folder, of one frame in a sequence.
#pragma once

#include <string>

#include "slf/frame_inputs.h"
#include "tools/failure.h"

namespace slf::tools {

/// With %d for the frame's number, or the same of all frames.
std::string file_of_frame(const std::string& given, const FrameInput& frame);

/// --images of one frame: with %d for its number, or within a folder one that is called as the
/// frame is; of a capture of all frames the folder itself. Empty where nothing is given.
/// @errors kInputUnreadable: no such folder
Result<std::string, Failure> images_of_frame(const std::string& given, const FrameInput& frame);

}  // namespace slf::tools
