// SPDX-License-Identifier: Apache-2.0
// The files of a synthetic capture, and how a directory of ours is known.
#pragma once

#include <filesystem>
#include <string>

#include "slf/error.h"
#include "slf/types.h"
#include "tools/synth/rings.h"
#include "tools/synth/scene.h"

namespace slf::synth {

/// Leaves an empty images/ and a cameras.json that marks the directory as ours, without cameras.
/// @param force  a directory that holds something else is used too
Result<Done, InputError> prepare_capture(const std::filesystem::path& directory,
                                         const std::string& scene, bool force);

/// A photograph for every camera, under its name.
Result<Done, InputError> write_images(const Subject& subject, const Rings& rings, int supersampling,
                                      int threads, const std::filesystem::path& directory,
                                      const Progress& progress);

/// cameras.json, with the splits: to be written last.
Result<Done, InputError> write_cameras(const std::filesystem::path& directory,
                                       const std::string& scene, const Rings& rings);

}  // namespace slf::synth
