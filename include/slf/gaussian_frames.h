// SPDX-License-Identifier: Apache-2.0
// Splats that move to bytes: an instant after the other. Spec 6.8, 7.13, 8.12.
#pragma once

#include <cstddef>
#include <functional>

#include "slf/frames.h"
#include "slf/gaussians.h"
#include "slf/types.h"

namespace slf {

/// The splats of a frame, loaded when it is its turn. There may be none.
using LoadGaussians = std::function<Result<Gaussians, InputError>(std::size_t)>;

/// What encode_gaussian_frames() does first: plan_frames() of splats.
/// @return points are splats that show, cameras are 0
/// @errors those of encode_gaussian_frames() but for take's and the coder's
Result<PlannedFrames, InputError> plan_gaussian_frames(std::size_t frames,
                                                       const LoadGaussians& load,
                                                       const EncoderSettings& settings,
                                                       const FrameSettings& frame_settings,
                                                       const Progress& progress = {});

/// Codes splats of several instants: each frame is predicted from the one before. Splats need not
/// correspond, nor be as many. As in encode_gaussians(), one Q says how fine all is, and splats
/// that no pixel can show are left out. All frames have one grid, around the splats of all; its
/// step goes by the median deviation of the first frame that shows something.
/// A frame of which nothing shows is empty (format 1.2).
/// @param frames  how many there are, 1 or more. Each is loaded twice: for the grid, and to be
///                coded; with a target bitrate some five times more
/// @param settings  q, or target_bitrate; grid_bits or voxel_size in place of the grid; what
///                  CodingParameters are made of; metadata, metres_per_unit, threads. Nothing else
///                  of it counts.
/// @param frame_settings  hold_still and hold_over_groups are of photographs: nothing here
/// @param origin  world place that positions are from
/// @errors kInvalidArgument: settings that frames do not have, no frame that shows something;
///         kInvalidInput: a frame of another degree or up axis than those before, by its place;
///         those of load, take and FrameEncoder
/// One frame is in memory at a time, and the one before as it was decoded. The same bytes for any
/// thread count, and for any division into parts.
Result<EncodedFrames, InputError> encode_gaussian_frames(
    std::size_t frames, const LoadGaussians& load, const EncoderSettings& settings,
    const FrameSettings& frame_settings, const TakeFrame& take, const Progress& progress = {},
    const Vec3& origin = {0, 0, 0});

}  // namespace slf
