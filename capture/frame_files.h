// SPDX-License-Identifier: Apache-2.0
// Frames that are a file each: clouds or splats, told by content.
#pragma once

#include <filesystem>
#include <string>

#include "slf/frame_inputs.h"

namespace slf {

/// An error of a frame, which names its file.
InputError bad_frame(const std::filesystem::path& path, const std::string& cause);

/// What is wrong with a file of such a name that looks_like_gaussians() does not know.
inline constexpr const char* kNoSplats = "by its content no file of Gaussian splats";
/// A name of splats that are no PLY.
bool is_splat_name(const std::filesystem::path& path);

/// Finds which frames are empty, and whether all others are clouds or all splats.
/// @errors kUnreadable; kInvalidInput: both kinds, an empty file, what a PLY's header refuses
Result<Done, InputError> check_frame_files(FrameInputs& inputs);

}  // namespace slf
