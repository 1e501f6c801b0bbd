// SPDX-License-Identifier: Apache-2.0
// The one place, with draco_encoder, that includes Draco: optional geometry coder. Spec 8.5.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slf/error.h"

namespace slf {

/// Morton codes of the positions, ascending.
/// @errors kOutOfRange: not a point cloud of at most max_points unsigned integer positions below
///         2^bits, or one twice. kUnsupported: this build has no Draco.
Result<std::vector<std::uint64_t>> decode_draco(std::span<const std::uint8_t> payload, int bits,
                                                std::uint64_t max_points);

}  // namespace slf
