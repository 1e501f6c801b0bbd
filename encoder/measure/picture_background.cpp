// SPDX-License-Identifier: Apache-2.0
#include "encoder/measure/picture_background.h"

#include <algorithm>
#include <cstddef>

#include "capture/quantile.h"

namespace slf {
namespace {

constexpr std::array<std::uint8_t, 3> kNothing{128, 128, 128};

/// (a alpha + b (255 - alpha)) / 255, rounded.
std::uint8_t blend(unsigned a, unsigned b, unsigned alpha) {
  return static_cast<std::uint8_t>((a * alpha + b * (255 - alpha) + 127) / 255);
}

}  // namespace

std::array<std::uint8_t, 3> picture_background(const Image& photograph,
                                               const std::vector<std::uint8_t>& object,
                                               bool alpha_is_mask) {
  if (photograph.channels == 4 && !alpha_is_mask) return kNothing;
  const auto width = static_cast<std::size_t>(photograph.width);
  const auto height = static_cast<std::size_t>(photograph.height);
  std::vector<std::size_t> border, free;
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      if (x > 0 && y > 0 && x + 1 < width && y + 1 < height) continue;
      border.push_back(y * width + x);
      if (!object[border.back()]) free.push_back(border.back());
    }
  if (free.empty()) free = border;
  std::array<std::uint8_t, 3> background{};
  std::vector<std::uint8_t> values(free.size());
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < free.size(); ++i)
      values[i] = photograph.data[free[i] * std::size_t(photograph.channels) + k];
    background[k] = median(values);
  }
  return background;
}

Image over_background(const Image& photograph, const std::array<std::uint8_t, 3>& background) {
  if (photograph.channels == 3) return photograph;
  Image out{photograph.width, photograph.height, 3, {}};
  out.data.resize(photograph.data.size() / 4 * 3);
  for (std::size_t i = 0; i < out.data.size() / 3; ++i) {
    const std::uint8_t* pixel = &photograph.data[4 * i];
    for (std::size_t k = 0; k < 3; ++k)
      out.data[3 * i + k] = blend(pixel[k], background[k], pixel[3]);
  }
  return out;
}

Image over_background(const Rendering& over_black, const std::array<std::uint8_t, 3>& background) {
  Image out = over_black.image;
  for (std::size_t i = 0; i < over_black.coverage.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const unsigned sum = out.data[3 * i + k] + blend(0, background[k], over_black.coverage[i]);
      out.data[3 * i + k] = static_cast<std::uint8_t>(std::min(sum, 255u));
    }
  return out;
}

}  // namespace slf
