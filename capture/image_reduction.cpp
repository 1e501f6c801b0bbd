// SPDX-License-Identifier: Apache-2.0
#include "capture/image_reduction.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace slf {
namespace {

Image halved(const Image& image, int mean_channels) {
  Image half{(image.width + 1) / 2, (image.height + 1) / 2, image.channels, {}};
  half.data.reserve(image.data.size() / 4 + image.data.size() / 16);
  const auto at = [&](int x, int y, int c) -> int {
    const auto pixel = static_cast<std::size_t>(std::min(y, image.height - 1)) *
                           static_cast<std::size_t>(image.width) +
                       static_cast<std::size_t>(std::min(x, image.width - 1));
    return image
        .data[pixel * static_cast<std::size_t>(image.channels) + static_cast<std::size_t>(c)];
  };
  for (int y = 0; y < image.height; y += 2)
    for (int x = 0; x < image.width; x += 2)
      for (int c = 0; c < image.channels; ++c) {
        const int a = at(x, y, c), b = at(x + 1, y, c), d = at(x, y + 1, c),
                  e = at(x + 1, y + 1, c);
        half.data.push_back(static_cast<std::uint8_t>(c < mean_channels ? (a + b + d + e + 2) / 4
                                                                        : std::min({a, b, d, e})));
      }
  return half;
}

}  // namespace

Image reduced(Image image, int log2) {
  for (int i = 0; i < log2; ++i) image = halved(image, 3);
  return image;
}

Image reduced_mask(Image mask, int log2) {
  for (int i = 0; i < log2; ++i) mask = halved(mask, 0);
  return mask;
}

}  // namespace slf
