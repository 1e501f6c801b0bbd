// The digest of a slice's integers. Spec 7.9.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "slf/types.h"

namespace slf {

/// SHA-256 of positions, then a 64-bit hash of the components of each point, where there are any,
/// then normals, all little endian. It finds the mistakes of decoders; it is no protection against
/// forgery.
/// @param components  [positions][3 K]
std::array<std::uint8_t, 32> slice_digest(std::span<const Voxel> positions,
                                          std::span<const std::int32_t> components,
                                          std::span<const std::array<std::uint16_t, 2>> normals);

}  // namespace slf
