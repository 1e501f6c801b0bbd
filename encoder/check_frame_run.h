// SPDX-License-Identifier: Apache-2.0
// What all frames in time have in common, whatever they are made of.
#pragma once

#include <cstddef>

#include "slf/frames.h"

namespace slf {

/// @errors kInvalidArgument: settings that no frames have; a group, a rate or a part that is none
Result<Done, InputError> check_frame_run(std::size_t frames, const EncoderSettings& settings,
                                         const FrameSettings& frame_settings);

/// What was found of one of them, with its place in the message.
Result<Done, InputError> of_frame(std::size_t f, const Result<Done, InputError>& checked);

}  // namespace slf
