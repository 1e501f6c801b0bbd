// SPDX-License-Identifier: Apache-2.0
// The integers of a light field on their way into the slices of a scene.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/encoder/scene_encoder.h"
#include "slf/types.h"

namespace slf {

/// The light field in Morton order, with the codes.
struct SortedField {
  std::vector<std::uint64_t> morton;
  std::vector<Voxel> positions;
  std::vector<std::int32_t> components;
  std::vector<std::array<std::uint16_t, 2>> normals;
};

/// @errors kInvalidArgument: two points in one voxel
Result<SortedField, InputError> sort_points(const LightField& field);

/// The same, and the field has no points after it: those that are in order are not copied.
Result<SortedField, InputError> take_points(LightField& field);

/// Base and slices.
Result<std::vector<CodedUnit>, InputError> code_scene(SortedField& sorted,
                                                      const SceneLayout& layout,
                                                      const SliceCoding& coding, int threads);

}  // namespace slf
