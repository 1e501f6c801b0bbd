// SPDX-License-Identifier: Apache-2.0
// One slice of a planned scene: its points and photographs to units.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "codec/encoder/coded_unit.h"
#include "encoder/parts/depth_maps.h"
#include "encoder/parts/planned_scene.h"

namespace slf {

struct CodedSlice {
  std::size_t slice = 0;
  std::vector<CodedUnit> units;    ///< in the order of a slice's units
  std::vector<std::int32_t> sums;  ///< [its cells][planes] for the base: put_into_base
  std::size_t points = 0, around = 0, cameras = 0, observations = 0, unobserved = 0;
};

/// [P][3 K] coefficients of points that no camera sees: the cloud's own colours, or grey.
std::vector<float> unseen_coefficients(const VoxelCloud& cloud, std::size_t functions);

/// Depends on the plan and on what is near to the slice, on nothing else.
/// @errors those of observe, fit_view_maps, load_image and of reading points
Result<CodedSlice, InputError> encode_slice(const PlannedScene& scene, const Capture& capture,
                                            const DepthMaps& depth, std::size_t slice,
                                            const Progress& progress);

}  // namespace slf
