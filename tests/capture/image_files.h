// SPDX-License-Identifier: Apache-2.0
// Image files written by hand, so that it is not the library that tests itself.
#pragma once

#include <zlib.h>

#include <initializer_list>
#include <string>

#include "capture_support.h"

namespace slf::test {

inline std::string chunk(const std::string& type, const std::string& data) {
  const std::string covered = type + data;
  ByteString out;
  out.put(static_cast<std::uint32_t>(data.size()), true).text(covered);
  const auto crc =
      ::crc32(0, reinterpret_cast<const Bytef*>(covered.data()), static_cast<uInt>(covered.size()));
  return out.put(static_cast<std::uint32_t>(crc), true).bytes;
}

inline std::string deflated(const std::string& raw) {
  uLongf size = ::compressBound(raw.size());
  std::string out(size, '\0');
  EXPECT_EQ(::compress(reinterpret_cast<Bytef*>(out.data()), &size,
                       reinterpret_cast<const Bytef*>(raw.data()), raw.size()),
            Z_OK);
  out.resize(size);
  return out;
}

// @param rows  filter type 0 and samples of each row
inline std::string png(std::uint32_t width, std::uint32_t height, int depth, int colour_type,
                       const std::string& rows, const std::string& before_data = "") {
  ByteString header;
  header.put(width, true).put(height, true);
  header.put(std::uint8_t(depth)).put(std::uint8_t(colour_type)).text(std::string(3, '\0'));
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header.bytes) + before_data +
         chunk("IDAT", deflated(rows)) + chunk("IEND", "");
}

inline std::string bytes(std::initializer_list<int> values) {
  std::string text;
  for (const int value : values) text += static_cast<char>(value);
  return text;
}

inline std::string from_hex(const std::string& hex) {
  std::string text;
  for (std::size_t i = 0; i < hex.size(); i += 2)
    text += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  return text;
}

inline Result<Image, InputError> read(const std::string& file) {
  const TemporaryDirectory directory;
  test::write_text(directory / "image", file);
  return read_image(directory / "image");
}

}  // namespace slf::test
