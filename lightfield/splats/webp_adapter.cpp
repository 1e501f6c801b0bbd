// SPDX-License-Identifier: Apache-2.0
#include "lightfield/splats/webp_adapter.h"

#include <algorithm>

#if SLF_WITH_WEBP
#include <webp/decode.h>
#include <webp/encode.h>
#endif

namespace slf {

#if SLF_WITH_WEBP
namespace {

constexpr int kWebpEffort = 7;  // of 0 .. 9

/// What libwebp holds while it writes.
struct WebpWriting {
  WebPPicture picture{};
  WebPMemoryWriter writer{};

  WebpWriting() {
    WebPPictureInit(&picture);
    WebPMemoryWriterInit(&writer);
  }
  ~WebpWriting() {
    WebPMemoryWriterClear(&writer);
    WebPPictureFree(&picture);
  }
  WebpWriting(const WebpWriting&) = delete;
  WebpWriting& operator=(const WebpWriting&) = delete;
};

}  // namespace

bool has_webp() { return true; }

std::optional<RgbaPicture> decode_webp(std::span<const std::uint8_t> file, std::size_t most) {
  int width = 0, height = 0;
  if (WebPGetInfo(file.data(), file.size(), &width, &height) == 0 || width < 1 || height < 1)
    return std::nullopt;
  RgbaPicture picture{static_cast<std::size_t>(width), static_cast<std::size_t>(height), {}};
  if (picture.width * picture.height > most) return std::nullopt;
  picture.pixels.resize(4 * picture.width * picture.height);
  if (WebPDecodeRGBAInto(file.data(), file.size(), picture.pixels.data(), picture.pixels.size(),
                         4 * width) == nullptr)
    return std::nullopt;
  return picture;
}

std::optional<std::vector<std::uint8_t>> encode_webp(const RgbaPicture& picture) {
  if (std::max(picture.width, picture.height) > kMostWebpSide) return std::nullopt;
  WebPConfig config;
  if (WebPConfigInit(&config) == 0 || WebPConfigLosslessPreset(&config, kWebpEffort) == 0)
    return std::nullopt;
  config.exact = 1;
  WebpWriting writing;
  writing.picture.use_argb = 1;
  writing.picture.width = static_cast<int>(picture.width);
  writing.picture.height = static_cast<int>(picture.height);
  writing.picture.writer = WebPMemoryWrite;
  writing.picture.custom_ptr = &writing.writer;
  if (WebPPictureImportRGBA(&writing.picture, picture.pixels.data(), 4 * writing.picture.width) ==
          0 ||
      WebPEncode(&config, &writing.picture) == 0)
    return std::nullopt;
  return std::vector<std::uint8_t>(writing.writer.mem, writing.writer.mem + writing.writer.size);
}
#else
bool has_webp() { return false; }

std::optional<RgbaPicture> decode_webp(std::span<const std::uint8_t>, std::size_t) {
  return std::nullopt;
}

std::optional<std::vector<std::uint8_t>> encode_webp(const RgbaPicture&) { return std::nullopt; }
#endif

}  // namespace slf
