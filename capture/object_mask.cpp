// SPDX-License-Identifier: Apache-2.0
#include "capture/object_mask.h"

#include <algorithm>
#include <cstddef>

namespace slf {

void flatten_mask(Image& mask) {
  const bool of_small_numbers = std::none_of(mask.data.begin(), mask.data.end(), shows_object);
  for (std::uint8_t& sample : mask.data)
    sample = (of_small_numbers ? sample > 0 : shows_object(sample)) ? 255 : 0;
}

Image without_opaque_alpha(Image image) {
  if (image.channels != 4) return image;
  for (std::size_t i = 3; i < image.data.size(); i += 4)
    if (image.data[i] != 255) return image;
  Image opaque{image.width, image.height, 3, {}};
  opaque.data.reserve(image.data.size() / 4 * 3);
  for (std::size_t i = 0; i + 3 < image.data.size(); i += 4)
    opaque.data.insert(opaque.data.end(), &image.data[i], &image.data[i] + 3);
  return opaque;
}

}  // namespace slf
