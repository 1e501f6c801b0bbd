// SPDX-License-Identifier: Apache-2.0
#include "lightfield/splats/webp_adapter.h"

#if SLF_WITH_WEBP
#include <webp/decode.h>
#endif

namespace slf {

#if SLF_WITH_WEBP
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
#else
bool has_webp() { return false; }

std::optional<RgbaPicture> decode_webp(std::span<const std::uint8_t>, std::size_t) {
  return std::nullopt;
}
#endif

}  // namespace slf
