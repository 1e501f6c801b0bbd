// SPDX-License-Identifier: Apache-2.0
// What slf encode says of frames, as JSON and as text: before and after they are coded.
#pragma once

#include "slf/frame_inputs.h"
#include "slf/frames.h"
#include "tools/encode_options.h"

namespace slf::tools {

/// --dry-run, on standard output.
Outcome report_plan(const EncodeOptions& given, const FrameInputs& inputs,
                    const PlannedFrames& plan, const FrameSettings& settings);

/// @param bytes  of the file
Outcome report_frames(const EncodeOptions& given, const FrameInputs& inputs,
                      const EncodedFrames& encoded, std::size_t bytes,
                      const FrameSettings& settings);

}  // namespace slf::tools
