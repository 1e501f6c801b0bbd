// SPDX-License-Identifier: Apache-2.0
// Scenes that move: what `slf synth --frames` draws.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/synth/moving_part.h"

namespace slf::synth {

struct MovingScene {
  std::vector<MovingPart> parts;
  std::vector<Lamp> lamps;  ///< they stand still
  double radius;            ///< of a sphere around the origin that holds every part at every time
  bool cloud = false;       ///< frames are clouds on a grid; else captures
  double noise = 0;         ///< of clouds: samples are moved along their normals in every frame, by
                            ///< up to so many voxels either way
};

/// Clouds "still", "noise", "rot1", "rot4", "tube2", "tube8", captures "turn", "twist", "walk",
/// "appear"; nothing for any other name.
std::optional<MovingScene> make_moving_scene(const std::string& name);
/// All names, for messages.
std::string moving_scene_names();

/// What moving_scene.cpp puts together.
/// @param degrees_a_frame  about the first axis; 3/4 of it about the second
MovingScene turning_can(double degrees_a_frame);
/// @param speed  1: the ends turn against each other by 2 degrees a frame
MovingScene twisting_tube(double speed);
MovingScene walking_figure();
MovingScene appearing_ball();

}  // namespace slf::synth
