// SPDX-License-Identifier: Apache-2.0
// Captures and clouds that move: a directory with an entry for every frame.
#pragma once

#include <filesystem>
#include <string>

#include "slf/error.h"
#include "slf/types.h"

namespace slf::synth {

struct MovingSettings {
  std::string scene;  ///< one of moving_scene_names()
  int frames = 8;     ///< 1 .. 9999
  int threads = 0;    ///< 0: all cores. The result does not depend on it
  bool force = false;
  int bits = 0;   ///< of the grid of clouds, 5 .. 12; 0: 8. Captures have none
  int views = 0;  ///< of clouds: colours for so many, 2 .. 254; 0: one colour
  // Captures alone:
  int width = 256, height = 256;  ///< 8 .. 4096 pixels
  int points = 0;                 ///< about so many, 100 .. 10,000,000; 0: 40,000
  int circles = 0;                ///< cameras: 1 .. 99; 0: 3
  int per_circle = 0;             ///< 1 .. 360; 0: 8. At least 2 cameras in all
  int supersampling = 2;          ///< 1 .. 8
  double camera_turn = 0;         ///< degrees about the upright axis that all cameras go on by in a
                                  ///< frame, -180 .. 180
};

/// Writes frame_0001/, frame_0002/, ... each a capture as synthesise() has it, or frame_0001.ply,
/// ... clouds of whole numbers on one grid. Cameras have the same names and sizes in all frames;
/// every fourth is for evaluation. moving.json marks the directory as ours: such a one is used
/// again, its frames removed; else it must be new or empty, but for `force`.
/// @errors kInvalidArgument: a setting, names it. kUnwritable
Result<Done, InputError> synthesise_moving(const MovingSettings& settings,
                                           const std::filesystem::path& directory,
                                           const Progress& progress = {});

/// "frame_0001".
std::string frame_name(int number);

}  // namespace slf::synth
