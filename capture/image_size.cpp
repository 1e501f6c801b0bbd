// SPDX-License-Identifier: Apache-2.0
// Image headers read by hand, so that hundreds of images can be checked without decoding one.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "capture/image_formats.h"
#include "capture/netpbm.h"

namespace slf {

namespace {

constexpr std::array<std::uint8_t, 8> kPngSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr std::size_t kPngHeader = 8 + 4 + 4 + 8;  // signature, length, "IHDR", width and height

std::uint32_t big_endian_at(Bytes bytes, std::size_t at, int count) {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i) value = value << 8 | bytes[at + static_cast<std::size_t>(i)];
  return value;
}

// SOF0 .. SOF15, without DHT (C4), JPG (C8) and DAC (CC).
bool is_start_of_frame(std::uint8_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

}  // namespace

std::optional<std::string> image_size_problem(ImageSize size) {
  const auto text = std::to_string(size.width) + " x " + std::to_string(size.height);
  if (size.width == 0 || size.height == 0) return "image of " + text + " pixels";
  if (size.width > kMaxImageSide || size.height > kMaxImageSide ||
      std::uint64_t{size.width} * size.height > kMaxImagePixels)
    return "image of " + text + " pixels is larger than accepted";
  return std::nullopt;
}

bool is_png(Bytes file) {
  return file.size() >= kPngSignature.size() &&
         std::equal(kPngSignature.begin(), kPngSignature.end(), file.begin());
}

bool is_jpeg(Bytes file) {
  return file.size() >= 3 && file[0] == 0xFF && file[1] == 0xD8 && file[2] == 0xFF;
}

std::optional<ImageSize> png_size(Bytes start) {
  if (start.size() < kPngHeader || !is_png(start)) return std::nullopt;
  if (std::memcmp(start.data() + 12, "IHDR", 4) != 0) return std::nullopt;
  return ImageSize{big_endian_at(start, 16, 4), big_endian_at(start, 20, 4)};
}

std::optional<ImageSize> jpeg_size(Bytes start) {
  if (!is_jpeg(start)) return std::nullopt;
  // Segments: FF (any number), marker, two bytes of length that count themselves.
  for (std::size_t at = 2; at + 4 <= start.size();) {
    if (start[at] != 0xFF) return std::nullopt;
    const std::uint8_t marker = start[at + 1];
    if (marker == 0xFF) {
      ++at;
      continue;
    }
    if (marker == 0x01 || (marker >= 0xD0 && marker <= 0xD7)) {  // TEM, RSTn: no length
      at += 2;
      continue;
    }
    if (marker == 0xD9 || marker == 0xDA) return std::nullopt;  // the data begins without a frame
    const std::uint32_t length = big_endian_at(start, at + 2, 2);
    if (length < 2) return std::nullopt;
    if (is_start_of_frame(marker)) {
      if (at + 9 > start.size()) return std::nullopt;
      return ImageSize{big_endian_at(start, at + 7, 2), big_endian_at(start, at + 5, 2)};
    }
    at += 2 + std::size_t{length};
  }
  return std::nullopt;
}

Result<ImageSize, InputError> read_image_size(const std::filesystem::path& file) {
  SLF_TRY(const ImageHeader header, read_image_header(file));
  return header.size;
}

Result<ImageHeader, InputError> read_image_header(const std::filesystem::path& file) {
  struct Close {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  const std::unique_ptr<std::FILE, Close> in(std::fopen(file.c_str(), "rbe"));
  const auto unreadable = [&] {
    return InputError{Errc::kUnreadable, file.string() + ": " + std::strerror(errno)};
  };
  if (in == nullptr) return unreadable();
  std::setvbuf(in.get(), nullptr, _IONBF, 0);
  // Doubling steps: 4 KiB hold nearly every header; EXIF and ICC segments of a JPEG can come before
  // the frame header, 64 KiB each.
  std::vector<std::uint8_t> start;
  for (std::size_t want = 4096; want <= std::size_t{1} << 24; want *= 8) {
    const std::size_t have = start.size();
    start.resize(want);
    const std::size_t count = std::fread(start.data() + have, 1, want - have, in.get());
    start.resize(have + count);
    if (std::ferror(in.get()) != 0) return unreadable();
    if (png_size(start)) return png_header(start);
    if (jpeg_size(start)) return jpeg_header(start);
    if (const auto size = netpbm_size(start)) return ImageHeader{*size};
    if (!is_jpeg(start) || start.size() < want) break;
  }
  const char* cause = is_png(start)    ? ": PNG without a header (truncated?)"
                      : is_jpeg(start) ? ": JPEG without a frame header (truncated?)"
                                       : ": neither PNG, JPEG nor PPM";
  return InputError{Errc::kInvalidInput, file.string() + cause};
}

}  // namespace slf
