// SPDX-License-Identifier: Apache-2.0
// Mirror of attributes/texture/texture_decoder.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "attributes/texture/atlas.h"
#include "slf/encoder.h"

namespace slf {

/// The payload of a coefficient unit, behind its header. Offsets are the least values, samples are
/// clamped to settings.bits.
/// @param source  fills in the values of all points of a plane; called at most twice a plane
/// @errors kInvalidArgument: values that could reach 2^30; those of encode_hevc.
Result<std::vector<std::uint8_t>, InputError> encode_texture(
    const Atlas& atlas, std::span<const std::uint32_t> steps, const TextureSettings& settings,
    const std::function<void(std::size_t plane, std::span<std::int32_t> values)>& source);

}  // namespace slf
