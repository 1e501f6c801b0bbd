// SPDX-License-Identifier: Apache-2.0
// A plenoptic cloud of an analytic scene: what each of N cameras sees of each voxel.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "slf/error.h"
#include "slf/plenoptic.h"
#include "slf/types.h"
#include "tools/synth/vec.h"

namespace slf::synth {

struct PlenopticScene {
  std::string scene;       ///< "can", "die" or "vase"
  int views = 13;          ///< 2 .. 254, spread over a sphere
  int points = 0;          ///< about so many; 0: a quarter of the surface at 12 bits
  std::uint32_t seed = 1;  ///< of which voxels are kept, and of the noise
  int threads = 0;         ///< the result does not depend on it
};

/// Writes a PLY: a quarter of the voxels of the surface, as scanned clouds are sparse, with the
/// mean colour and that of every view, and noise of one grey level. A view that a voxel turns away
/// from has the mean of those that see it. Positions of views are comment lines.
/// @errors kInvalidArgument: a setting, names it. kUnwritable
Result<Done, InputError> synthesise_plenoptic(const PlenopticScene& settings,
                                              const std::filesystem::path& file,
                                              const Progress& progress = {});

/// So many, spread evenly, z from top to bottom.
std::vector<Vec3> view_places(int views);
/// Does a view see a surface that has this normal?
bool sees(const Vec3& to_view, const Vec3& normal);
/// Names and places of views; no points.
/// @param low, step  of the voxels
PlenopticCloud cloud_of_views(std::span<const Vec3> views, const Vec3& low, double step);
/// The mean of views, then what each sees, with noise of about one grey level.
/// @param seen    display colours; views that see nothing have the mean of those that do
/// @param unseen  the colour that all have where none sees it
/// @param number  what the noise is made of: another for every point
void write_views(std::span<const std::optional<Vec3>> seen, const Vec3& unseen,
                 std::uint64_t number, std::uint8_t* colours);

}  // namespace slf::synth
