// SPDX-License-Identifier: Apache-2.0
// What an encoding begins with, for whatever reads a capture to code it: the cameras of its split,
// and what the file says of its input.
#pragma once

#include <string>
#include <vector>

#include "slf/capture.h"
#include "slf/error.h"
#include "slf/types.h"

namespace slf {

/// What split_cameras() makes of "": the name that is kept with the file.
std::string split_name(const Capture& capture, const std::string& given);

/// The cameras of the split; none of a capture that has none.
/// @errors kInvalidArgument: a split is named that the capture does not have, or that has no
///         cameras. kInvalidInput: the split has no images
Result<std::vector<int>, InputError> input_cameras(const Capture& capture,
                                                   const std::string& split);

/// Leaves out photographs whose mask or alpha shows nothing of the object.
/// @param which  "input", "held-out"
/// @return a warning; empty where all show it
std::string leave_out_empty(const Capture& capture, const char* which, int threads,
                            std::vector<int>& cameras);

/// The same of input cameras.
/// @errors kInvalidInput: none shows anything, which is a mistake and no input
Result<std::string, InputError> leave_out_empty_inputs(const Capture& capture, int threads,
                                                       std::vector<int>& cameras);

/// What the metadata of a file say of its input: source, split, crs.
/// @param path  of the capture, whose last component is kept and never more, so that no machine's
///              paths get into a file; empty: it was in memory
Metadata input_metadata(const Capture& capture, const std::vector<int>& cameras,
                        const std::string& split, const std::string& path);

}  // namespace slf
