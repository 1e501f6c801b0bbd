// SPDX-License-Identifier: Apache-2.0
// Reading zlib streams, for metadata alone: small rather than fast. Spec 7.8.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slf/error.h"

namespace slf {

/// A zlib stream (RFC 1950) of deflated data (RFC 1951), without a preset dictionary. Exactly
/// `size` bytes must come out, the whole input must be used, the checksum must agree.
/// @errors kOutOfRange at `element`. O(8 * bytes + size).
Result<std::vector<std::uint8_t>> inflate(std::span<const std::uint8_t> bytes, std::size_t size,
                                          const char* element);

}  // namespace slf
