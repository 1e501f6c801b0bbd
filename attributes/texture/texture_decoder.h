// SPDX-License-Identifier: Apache-2.0
// The planes of a group from their pictures. Spec 8.11.6.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "attributes/texture/atlas.h"
#include "slf/error.h"

namespace slf {

/// @param payload  of a coefficient unit, behind its header
/// @param bits     of a sample: 8, 10 or 12
/// @param steps    [planes of the group] 1 .. 2^27 - 1
/// @param sink     called for every plane of the group once with the values of all points, on this
///                 thread; planes without a picture come first. What it was given counts only if
///                 the call succeeds
/// @errors kOutOfRange tx_offset: values could reach 2^30. Those of decode_hevc. O(planes * pixels)
Result<Done> decode_texture(
    std::span<const std::uint8_t> payload, const Atlas& atlas, int bits,
    std::span<const std::uint32_t> steps,
    const std::function<void(std::size_t plane, std::span<const std::int32_t> values)>& sink);

}  // namespace slf
