// SPDX-License-Identifier: Apache-2.0
#include "capture/object_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "capture/object_mask.h"
#include "capture/quantile.h"

namespace slf {
namespace {

constexpr int kLike = 14;           // grey levels: noise of a background, not the object
constexpr int kLeastNoise = 5;      // grey levels: as JPEG leaves a plain one
constexpr double kQuiet = 0.95;     // of the border, with so little noise or a third of it
constexpr double kEvenShare = 0.9;  // of the border that is alike
constexpr double kLeastOfObject = 0.002,
                 kMostOfObject = 0.95;  // of a photograph that is the object

std::vector<std::size_t> border_of(int width, int height) {
  std::vector<std::size_t> border;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (x == 0 || y == 0 || x + 1 == width || y + 1 == height)
        border.push_back(std::size_t(y) * std::size_t(width) + std::size_t(x));
  return border;
}

/// Pixels of a colour like the border's.
std::vector<std::uint8_t> like_border(const Image& image, const std::vector<std::size_t>& border,
                                      Background background) {
  std::array<int, 3> colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<std::uint8_t> values;
    for (const std::size_t pixel : border) values.push_back(image.data[3 * pixel + c]);
    colour[c] = median(std::move(values));
  }
  const auto apart = [&](std::size_t i) {
    int most = 0;
    for (std::size_t c = 0; c < 3; ++c)
      most = std::max(most, std::abs(int(image.data[3 * i + c]) - colour[c]));
    return most;
  };
  int limit = kLike;
  if (background == Background::kCertain) {
    std::vector<int> noise;
    for (const std::size_t pixel : border) noise.push_back(apart(pixel));
    limit = std::clamp(3 * quantile(std::move(noise), kQuiet), kLeastNoise, kLike);
  }
  std::vector<std::uint8_t> like(image.data.size() / 3);
  for (std::size_t i = 0; i < like.size(); ++i) like[i] = apart(i) <= limit;
  return like;
}

/// All but what is `like` and connected with the border.
std::vector<std::uint8_t> all_but_outside(const std::vector<std::uint8_t>& like,
                                          std::vector<std::size_t> open, std::size_t width) {
  std::vector<std::uint8_t> object(like.size(), 1);
  const auto take = [&](std::size_t i) {
    if (!like[i] || !object[i]) return false;
    object[i] = 0;
    return true;
  };
  std::erase_if(open, [&](std::size_t i) { return !take(i); });
  while (!open.empty()) {
    const std::size_t i = open.back(), x = i % width;
    open.pop_back();
    if (x > 0 && take(i - 1)) open.push_back(i - 1);
    if (x + 1 < width && take(i + 1)) open.push_back(i + 1);
    if (i >= width && take(i - width)) open.push_back(i - width);
    if (i + width < like.size() && take(i + width)) open.push_back(i + width);
  }
  return object;
}

}  // namespace

std::vector<std::uint8_t> object_outline(const Image& photograph, Background background) {
  std::vector<std::uint8_t> object;
  if (photograph.channels == 4) {
    for (std::size_t i = 3; i < photograph.data.size(); i += 4)
      object.push_back(shows_object(photograph.data[i]));
  } else {
    const auto border = border_of(photograph.width, photograph.height);
    const auto like = like_border(photograph, border, background);
    const auto even = std::count_if(border.begin(), border.end(),
                                    [&](std::size_t pixel) { return like[pixel] != 0; });
    if (double(even) < kEvenShare * double(border.size())) return {};
    object = all_but_outside(like, border, std::size_t(photograph.width));
  }
  const auto shown = double(std::count(object.begin(), object.end(), 1));
  const auto all = double(object.size());
  if (shown < kLeastOfObject * all || shown > kMostOfObject * all) return {};
  return object;
}

}  // namespace slf
