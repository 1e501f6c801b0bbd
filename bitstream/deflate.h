// The one place that includes zlib: what an encoder writes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace slf {

/// A zlib stream, at zlib's best. Read by inflate().
std::vector<std::uint8_t> deflate(std::span<const std::uint8_t> bytes);
/// A gzip file (RFC 1952) without a name or a time; empty where there is no memory.
std::vector<std::uint8_t> gzip(std::span<const std::uint8_t> bytes);

}  // namespace slf
