// The one place that includes zlib.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slf/error.h"

namespace slf {

/// CRC-32 of ISO 3309 (zlib's), continued from `crc` (0 to begin).
std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc = 0);

std::vector<std::uint8_t> deflate(std::span<const std::uint8_t> bytes);
/// Exactly `size` bytes must come out, the whole input must be used; else kOutOfRange.
Result<std::vector<std::uint8_t>> inflate(std::span<const std::uint8_t> bytes, std::size_t size,
                                          const char* element);

}  // namespace slf
