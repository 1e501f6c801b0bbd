// SPDX-License-Identifier: Apache-2.0
// Captures of analytic scenes, so that the demo and the tests need no download.
#pragma once

#include <filesystem>
#include <string>

#include "slf/error.h"
#include "slf/types.h"
#include "tools/synth/disturb.h"

namespace slf::synth {

struct SynthSettings {
  std::string scene;              ///< "can", "die", "vase" or "terrace"
  int width = 256, height = 256;  ///< 8 .. 4096 pixels
  int points = 0;   ///< about so many, 100 .. 10,000,000, of the terrace to 100,000,000; 0: the
                    ///< scene's default density
  int threads = 0;  ///< 0: all cores. The result does not depend on it
  int circles = 11, per_circle = 50;  ///< cameras, 1 .. 99 and 1 .. 360; not of the terrace
  int houses = 0;           ///< of the terrace, 1 .. 10,000; 0: 12. No other scene has any
  int cameras = 0;          ///< the same, 2 .. 10,000; 0: 120
  int supersampling = 2;    ///< rays per pixel and axis, 1 .. 8
  DisturbSettings disturb;  ///< of the cloud; the photographs stay those of the scene.
                            ///< Its seed is the terrace's too
  /// Photographs differ in exposure by up to this share, and half as much again in each channel;
  /// 0 .. 0.5, not of the terrace.
  double exposure_drift = 0;
  bool mesh = false;   ///< mesh.obj as well; of the can and the vase
  bool force = false;  ///< write into a foreign directory that is not empty
};

/// Writes a capture: points.ply, cameras.json, images/NNNN.png (see docs/captures.md). Existing
/// directories are used if they are empty or hold an earlier synthetic capture, which is replaced.
/// A disturbed cloud has the true one beside it, as exact.ply, for measurements.
/// cameras.json is written last: a capture cut short has no cameras.
/// @errors kInvalidArgument: a setting out of range, names it. kUnwritable: the directory holds
///         something else (see force), or cannot be written.
Result<Done, InputError> synthesise(const SynthSettings& settings,
                                    const std::filesystem::path& directory,
                                    const Progress& progress = {});

}  // namespace slf::synth
