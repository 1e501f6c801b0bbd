// SPDX-License-Identifier: Apache-2.0
// A plenoptic cloud of an analytic scene: what each of N cameras sees of each voxel.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "slf/error.h"
#include "slf/types.h"

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

}  // namespace slf::synth
