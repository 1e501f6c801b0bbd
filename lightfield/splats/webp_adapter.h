// SPDX-License-Identifier: Apache-2.0
// The one place that includes libwebp: pictures of SOG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace slf {

/// Whether this build has it.
bool has_webp();

/// Four bytes a pixel, rows from the top.
struct RgbaPicture {
  std::size_t width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
};

/// Decodes a WebP file. Nothing where it is damaged, has more pixels than `most`, which is looked
/// at before there is memory for them, or has_webp() is false.
std::optional<RgbaPicture> decode_webp(std::span<const std::uint8_t> file, std::size_t most);

/// A lossless WebP file in which pixels that are transparent keep their colours. The same bytes for
/// the same picture. Nothing where a side is 0 or beyond kMostWebpSide, there is no memory, or
/// has_webp() is false.
std::optional<std::vector<std::uint8_t>> encode_webp(const RgbaPicture& picture);
inline constexpr std::size_t kMostWebpSide = 16383;

}  // namespace slf
