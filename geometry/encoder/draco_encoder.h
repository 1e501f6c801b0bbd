// SPDX-License-Identifier: Apache-2.0
// Mirror of geometry/draco_decoder.h.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "slf/types.h"

namespace slf {

/// Lossless k-d tree coding of non-negative positions; nothing where this build has no Draco, or
/// where Draco fails.
std::optional<std::vector<std::uint8_t>> encode_draco(std::span<const Voxel> positions);

}  // namespace slf
