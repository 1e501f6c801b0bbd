// SPDX-License-Identifier: Apache-2.0
// The digest of a slice's integers. Spec 7.9.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "slf/types.h"

namespace slf {

/// SHA-256 of a sum of 64 bits for every 64 points: of positions, components, where there are any,
/// and normals. It finds the mistakes of decoders; it is no protection against forgery.
/// @param components  [positions][3 K]
std::array<std::uint8_t, 32> slice_digest(std::span<const Voxel> positions,
                                          std::span<const std::int32_t> components,
                                          std::span<const std::array<std::uint16_t, 2>> normals);

}  // namespace slf
