// SPDX-License-Identifier: Apache-2.0
// Source: EXIF 2.32, 4.6.4, Orientation: where the 0th row and column of the file are shown.
#include "capture/upright.h"

#include <algorithm>
#include <cstddef>

namespace slf {

Image upright(Image image, int orientation) {
  if (orientation < 2 || orientation > 8) return image;
  const bool swapped = orientation >= 5;  // rows of the file are shown as columns
  const bool right = orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
  const bool bottom = orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
  Image turned{swapped ? image.height : image.width,
               swapped ? image.width : image.height,
               image.channels,
               {}};
  turned.data.resize(image.data.size());
  const auto channels = static_cast<std::size_t>(image.channels);
  std::uint8_t* to = turned.data.data();
  for (int y = 0; y < turned.height; ++y)
    for (int x = 0; x < turned.width; ++x, to += channels) {
      const int column = swapped ? y : x, row = swapped ? x : y;
      const auto from_x = static_cast<std::size_t>(right ? image.width - 1 - column : column);
      const auto from_y = static_cast<std::size_t>(bottom ? image.height - 1 - row : row);
      const std::size_t at = (from_y * static_cast<std::size_t>(image.width) + from_x) * channels;
      std::copy_n(image.data.data() + at, channels, to);
    }
  return turned;
}

}  // namespace slf
