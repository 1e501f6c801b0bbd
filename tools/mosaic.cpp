// SPDX-License-Identifier: Apache-2.0
#include "tools/mosaic.h"

#include <algorithm>
#include <cmath>

namespace slf::tools {

Image opaque(const Image& image, const std::array<std::uint8_t, 3>& background) {
  if (image.channels == 3) return image;
  Image out;
  out.width = image.width;
  out.height = image.height;
  out.data.reserve(image.data.size() / 4 * 3);
  for (std::size_t i = 0; i + 3 < image.data.size(); i += 4) {
    const unsigned alpha = image.data[i + 3];
    for (std::size_t c = 0; c < 3; ++c)
      out.data.push_back(static_cast<std::uint8_t>(
          (image.data[i + c] * alpha + background[c] * (255 - alpha) + 127) / 255));
  }
  return out;
}

Image mosaic(const std::vector<Image>& images, int columns,
             const std::array<std::uint8_t, 3>& background) {
  const auto count = static_cast<int>(images.size());
  const int rows = (count + columns - 1) / columns;
  Image out;
  out.width = columns * images[0].width;
  out.height = rows * images[0].height;
  out.data.resize(std::size_t(3) * std::size_t(out.width) * std::size_t(out.height));
  for (std::size_t i = 0; i < out.data.size(); ++i) out.data[i] = background[i % 3];
  const auto row_bytes = std::ptrdiff_t{3} * images[0].width;
  for (int n = 0; n < count; ++n)
    for (int y = 0; y < images[0].height; ++y) {
      const std::ptrdiff_t to_row = std::ptrdiff_t{n / columns} * images[0].height + y;
      std::copy_n(images[std::size_t(n)].data.begin() + y * row_bytes, row_bytes,
                  out.data.begin() + (to_row * columns + n % columns) * row_bytes);
    }
  return out;
}

int sheet_columns(int count) {
  const int widest = std::clamp(static_cast<int>(std::ceil(std::sqrt(2.0 * count))), 1, count);
  const int rows = (count + widest - 1) / widest;
  return (count + rows - 1) / rows;  // as few empty places as these rows allow
}

}  // namespace slf::tools
