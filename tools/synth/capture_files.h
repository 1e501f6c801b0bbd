// SPDX-License-Identifier: Apache-2.0
// The files of a synthetic capture, and how a directory of ours is known.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
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

/// prepare_capture, then `write`. What a failure (a full disk) leaves of a capture is removed, and
/// the directory if it was not there; not where it held something else.
Result<Done, InputError> write_capture(const std::filesystem::path& directory,
                                       const std::string& scene, bool force,
                                       const std::function<Result<Done, InputError>()>& write);

struct PhotographSettings {
  int supersampling = 2;
  double exposure_drift = 0;  ///< SynthSettings
  std::uint64_t seed = 1;     ///< of the drift
};

/// A photograph for every camera, under its name.
Result<Done, InputError> write_images(const Subject& subject, const Rings& rings,
                                      const PhotographSettings& settings, int threads,
                                      const std::filesystem::path& directory,
                                      const Progress& progress);

/// cameras.json, with the splits: to be written last.
Result<Done, InputError> write_cameras(const std::filesystem::path& directory,
                                       const std::string& scene, const Rings& rings);

}  // namespace slf::synth
