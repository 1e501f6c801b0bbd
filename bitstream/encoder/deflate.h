// SPDX-License-Identifier: Apache-2.0
// The one place that includes zlib: what an encoder writes, and files of others.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace slf {

/// A zlib stream, at zlib's best. Read by inflate().
std::vector<std::uint8_t> deflate(std::span<const std::uint8_t> bytes);
/// A gzip file (RFC 1952) without a name or a time; empty where there is no memory.
std::vector<std::uint8_t> gzip(std::span<const std::uint8_t> bytes);

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
