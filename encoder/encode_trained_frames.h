// SPDX-License-Identifier: Apache-2.0
// Photographs of several instants to splats that move.
#pragma once

#include <vector>

#include "slf/frames.h"

namespace slf {

/// Whether frames are trained: where splats are asked for, or no setting asks for a surface and
/// photographs have no points, or points that leave holes.
/// @param points  [F] of each
/// @param first   a frame with cameras and, where there is one, with points
bool are_trained(const EncoderSettings& settings, const std::vector<std::size_t>& points,
                 const LoadedFrame& first);

/// Trains the splats of all frames (encoder/train/splats_in_time.h), then codes them. Every frame's
/// splats are held, 150 bytes each.
/// @param frame_settings  without parts, since each frame goes on from the one before
/// @errors kInvalidInput: photographs train nothing; those of load, take and encode_gaussian_frames
Result<EncodedFrames, InputError> encode_trained_frames(std::size_t frames, const LoadFrame& load,
                                                        const EncoderSettings& settings,
                                                        const FrameSettings& frame_settings,
                                                        const TakeFrame& take,
                                                        const Progress& progress);

}  // namespace slf
