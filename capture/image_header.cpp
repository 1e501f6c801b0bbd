// SPDX-License-Identifier: Apache-2.0
// What stands beside the pixels of PNG and JPEG files: EXIF orientation, colour profiles, gamma.
// Sources: EXIF 2.32 4.6; PNG (ISO 15948) 11.3; ICC.1:2022 annex B.4.
#include <algorithm>
#include <cstring>
#include <string_view>

#include "capture/image_formats.h"

namespace slf {

namespace {

std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::uint32_t number(Bytes bytes, std::size_t at, std::size_t count, bool big_endian) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value = value << 8 | bytes[at + (big_endian ? i : count - 1 - i)];
  return value;
}

/// The orientation in a TIFF block; 1 where it says none that is one.
int orientation_of(Bytes tiff) {
  constexpr std::uint32_t kOrientation = 0x0112, kShort = 3;
  if (tiff.size() < 10) return 1;
  const bool big = text_of(tiff).starts_with("MM");
  if (!big && !text_of(tiff).starts_with("II")) return 1;
  const std::size_t directory = number(tiff, 4, 4, big);
  if (directory > tiff.size() - 2) return 1;
  const std::size_t entries = number(tiff, directory, 2, big);
  for (std::size_t i = 0; i < entries; ++i) {
    const std::size_t at = directory + 2 + 12 * i;
    if (at + 12 > tiff.size()) return 1;
    if (number(tiff, at, 2, big) != kOrientation || number(tiff, at + 2, 2, big) != kShort)
      continue;
    const std::uint32_t value = number(tiff, at + 8, 2, big);
    return value >= 1 && value <= 8 ? static_cast<int>(value) : 1;
  }
  return 1;
}

/// By the description in it, in ASCII or in UTF-16.
bool names_srgb(Bytes profile) {
  using namespace std::string_view_literals;
  const auto text = text_of(profile);
  return text.find("sRGB"sv) != text.npos || text.find("s\0R\0G\0B"sv) != text.npos;
}

}  // namespace

ImageHeader png_header(Bytes start) {
  ImageHeader header;
  if (const auto size = png_size(start)) header.size = *size;
  bool srgb = false, gamma = false, profile = false;
  for (std::size_t at = 8; at + 12 <= start.size();) {
    const std::size_t length = number(start, at, 4, true);
    const auto type = text_of(start.subspan(at + 4, 4));
    const Bytes data = start.subspan(at + 8, std::min(length, start.size() - at - 8));
    if (type == "IDAT") break;
    if (type == "IHDR" && data.size() >= 10) header.alpha = data[9] == 4 || data[9] == 6;
    if (type == "sRGB") srgb = true;
    // Named before what is compressed of it.
    if (type == "iCCP") profile = !names_srgb(data);
    if (type == "gAMA" && data.size() >= 4) {
      const std::uint32_t value = number(data, 0, 4, true);  // times 100000
      gamma = value < 43000 || value > 48000;
    }
    if (type == "eXIf") header.orientation = orientation_of(data);
    if (length > start.size()) break;
    at += 12 + length;
  }
  header.other_colour = !srgb && (profile || gamma);
  return header;
}

ImageHeader jpeg_header(Bytes start) {
  using namespace std::string_view_literals;
  constexpr auto kExif = "Exif\0\0"sv, kProfile = "ICC_PROFILE\0"sv;
  constexpr std::uint8_t kApp1 = 0xE1, kApp2 = 0xE2, kFirstFrame = 0xC0, kScan = 0xDA;
  ImageHeader header;
  if (const auto size = jpeg_size(start)) header.size = *size;
  for (std::size_t at = 2; at + 4 <= start.size();) {
    const std::uint8_t marker = start[at + 1];
    if (start[at] != 0xFF || marker == kFirstFrame || marker == kScan) break;
    if (marker == 0xFF || marker == 0x01 || (marker >= 0xD0 && marker <= 0xD7)) {
      at += marker == 0xFF ? 1 : 2;
      continue;
    }
    const std::size_t length = number(start, at + 2, 2, true);
    if (length < 2 || length + 2 > start.size() - at) break;
    const Bytes data = start.subspan(at + 4, length - 2);
    if (marker == kApp1 && text_of(data).starts_with(kExif))
      header.orientation = orientation_of(data.subspan(kExif.size()));
    // The first of several segments holds the description.
    if (marker == kApp2 && text_of(data).starts_with(kProfile) && data.size() > 14 && data[12] == 1)
      header.other_colour = !names_srgb(data);
    at += 2 + length;
  }
  return header;
}

}  // namespace slf
