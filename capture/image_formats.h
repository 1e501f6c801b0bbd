// SPDX-License-Identifier: Apache-2.0
// What the PNG and JPEG adapters offer: whole files in memory to and from images.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "slf/capture.h"

namespace slf {

using Bytes = std::span<const std::uint8_t>;

inline constexpr std::uint32_t kMaxImageSide = 65535;
inline constexpr std::uint64_t kMaxImagePixels = std::uint64_t{1} << 28;

struct ImageSize {
  std::uint32_t width = 0, height = 0;
};

/// A cause, if the size is one that is refused before anything is allocated.
std::optional<std::string> image_size_problem(ImageSize size);

bool is_png(Bytes file);
bool is_jpeg(Bytes file);

/// From the first bytes of a file, without decoding; nothing if they do not say.
std::optional<ImageSize> png_size(Bytes start);
std::optional<ImageSize> jpeg_size(Bytes start);

/// What a file says of itself before its pixels.
struct ImageHeader {
  ImageSize size;
  int orientation = 1;        ///< EXIF, 1 .. 8; 1: upright as stored
  bool alpha = false;         ///< a PNG with an alpha channel
  bool other_colour = false;  ///< an ICC profile or a gamma that is not sRGB's
};

/// Reads what a PNG or JPEG says of itself: a few kilobytes, more only if the header of a JPEG is
/// longer.
Result<ImageHeader, InputError> read_image_header(const std::filesystem::path& file);
Result<ImageSize, InputError> read_image_size(const std::filesystem::path& file);

/// The same from the first bytes of a file, whose size is known to be in them.
ImageHeader png_header(Bytes start);
ImageHeader jpeg_header(Bytes start);

/// To 8 bits, grey and palette to RGB; four channels where the file has alpha or tRNS.
/// @param name  for messages
Result<Image, InputError> decode_png(const std::string& name, Bytes file);
/// To RGB. EXIF orientation is ignored: a calibration refers to the stored pixels.
/// @param reduction  0 .. kMostJpegReduction: sides of a 2^reduction-th, rounded up
/// @param size       receives that of the file
Result<Image, InputError> decode_jpeg(const std::string& name, Bytes file, int reduction,
                                      ImageSize& size);
inline constexpr int kMostJpegReduction = 3;

/// read_image of a file that is made smaller.
/// @param size  receives that of the file
Result<Image, InputError> read_image_reduced(const std::filesystem::path& file, int reduction,
                                             ImageSize& size);

/// 8-bit RGB or RGBA. The image's fields fit together (write_png has checked).
Result<std::vector<std::uint8_t>, InputError> encode_png(const std::string& name,
                                                         const Image& image);

}  // namespace slf
