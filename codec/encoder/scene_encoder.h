// SPDX-License-Identifier: Apache-2.0
// Mirror of codec/decoder/scene_decoder.h.
#pragma once

#include <span>
#include <vector>

#include "codec/encoder/slice_encoder.h"

namespace slf {

/// All units of the base and of the slices, in the order of the stream: coarse first, so that a
/// beginning is the whole scene.
/// @param slices   [slices] their components are used up
/// @errors those of slices (codec/encoder/slice_encoder.h)
Result<CodedUnits, InputError> encode_scene(const SliceCoding& coding, const SceneLayout& layout,
                                            std::span<const SliceInput> slices, int threads);

}  // namespace slf
