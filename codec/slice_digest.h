// The digest of a slice's integers. Spec 7.9.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "slf/types.h"

namespace slf {

/// SHA-256 of positions, then components as 32-bit, then normals as 16-bit, all little endian.
std::array<std::uint8_t, 32> slice_digest(std::span<const Voxel> positions,
                                          std::span<const std::int32_t> components,
                                          std::span<const std::array<std::uint16_t, 2>> normals);

}  // namespace slf
