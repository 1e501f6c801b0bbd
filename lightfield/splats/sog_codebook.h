// SPDX-License-Identifier: Apache-2.0
// Numbers in bytes: a codebook of 256 values, as SOG has for sizes, colours and harmonics.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace slf {

struct ByteCodebook {
  std::array<float, 256> values{};  ///< ascending; the last ones repeat where fewer are needed
  std::vector<std::uint8_t> bytes;  ///< the nearest of them, for each number in its order

  float of(std::size_t i) const { return values[bytes[i]]; }
};

/// The codebook of least squared error, as far as Lloyd's method finds it from a start that is
/// half even and half as dense as the numbers are. Numbers of which there are at most `levels`
/// different ones are kept as they are.
/// @param numbers  finite, 1 or more
/// @param levels   1 .. 256
/// O(n log n). Source: Lloyd, "Least squares quantization in PCM" (1982).
ByteCodebook byte_codebook(const std::vector<float>& numbers, std::size_t levels);

}  // namespace slf
