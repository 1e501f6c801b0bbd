// The one place that reads gzip, which SPZ is in. The adapter of zlib beside bitstream/deflate.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace slf {

struct Gunzipped {
  std::vector<std::uint8_t> bytes;  ///< what came out before the end, the limit or the damage
  bool whole = false;               ///< the end was reached, and its checksum agrees
};

/// A gzip file (RFC 1952) of one member. Memory grows with what comes out.
/// @param most  bytes after which it ends
Gunzipped gunzip(std::span<const std::uint8_t> file, std::size_t most);

/// Most that a byte of deflated data can become (RFC 1951: 258 bytes for two bits).
inline constexpr std::size_t kMostDeflateRatio = 1032;

}  // namespace slf
