// SPDX-License-Identifier: Apache-2.0
// The checksum of units. Spec 7.1.
#pragma once

#include <cstdint>
#include <span>

namespace slf {

/// CRC-32 of ISO 3309 (zlib's), continued from `crc` (0 to begin).
std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc = 0);

}  // namespace slf
