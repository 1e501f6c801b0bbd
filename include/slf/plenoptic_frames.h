// SPDX-License-Identifier: Apache-2.0
// Plenoptic clouds that move to bytes: an instant after the other. Spec 7.13, 8.12.
#pragma once

#include <cstddef>
#include <functional>

#include "slf/frames.h"
#include "slf/plenoptic.h"

namespace slf {

/// The cloud of a frame, loaded when it is its turn. Without points nothing else of it counts.
using LoadPlenoptic = std::function<Result<PlenopticCloud, InputError>(std::size_t)>;

/// Can the two be frames of one sequence?
/// @errors kInvalidInput: another number of views, other names or types of properties, other
///         positions of views, voxels of another size or between those of the other
Result<Done, InputError> check_same_views(const PlenopticCloud& first, const PlenopticCloud& cloud);

/// The cloud on another grid of the same voxels.
/// @errors kInvalidInput: points beyond it; those of check_same_views that are of voxels
Result<PlenopticCloud, InputError> on_grid_of_voxels(PlenopticCloud cloud, const Grid& grid);

/// What encode_plenoptic_frames() does first: plan_frames() of plenoptic clouds.
/// @return cameras are 0
/// @errors those of encode_plenoptic_frames() but for take's and the coder's
Result<PlannedFrames, InputError> plan_plenoptic_frames(std::size_t frames,
                                                        const LoadPlenoptic& load,
                                                        const PlenopticSettings& settings,
                                                        const FrameSettings& frame_settings,
                                                        const Progress& progress = {});

/// Codes clouds of views of several instants: each frame is predicted from the one before. Points
/// need not correspond, nor be as many. Views and properties are those of all frames, and so is the
/// grid, around the points of all.
/// As planes frames are exact as encode_plenoptic() makes them: what prediction leaves is corrected
/// anew in each frame. With q or a target bitrate they have one step. As view maps all frames have
/// the functions that the first one with points chooses.
/// A frame without points is empty (format 1.2).
/// @param frames    how many there are, 1 or more. Each is loaded twice: for the grid, and to be
///                  coded; with a target bitrate some five times more
/// @param settings  as of encode_plenoptic(), but for its targets
/// @param frame_settings  hold_still and hold_over_groups are of photographs: nothing here
/// @errors kInvalidArgument: settings that frames or such clouds do not have; kInvalidInput: no
///         frame with points, one that is not of the views or voxels of the first, by its place;
///         those of load, take, encode_plenoptic() and FrameEncoder
/// One frame is in memory at a time, and the one before as it was decoded. The same bytes for any
/// thread count, and for any division into parts.
Result<EncodedFrames, InputError> encode_plenoptic_frames(
    std::size_t frames, const LoadPlenoptic& load, const PlenopticSettings& settings,
    const FrameSettings& frame_settings, const TakeFrame& take, const Progress& progress = {});

}  // namespace slf
