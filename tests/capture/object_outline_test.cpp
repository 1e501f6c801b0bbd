// SPDX-License-Identifier: Apache-2.0
#include "capture/object_outline.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace slf::object_outline_test {
namespace {

constexpr int kSide = 64, kObjectPixels = 32 * 32;

/// A square in the middle of a background of grey 128 that deviates by up to `noise`.
Image photograph(int square, int noise) {
  Image image{kSide, kSide, 3, {}};
  std::uint32_t state = 1;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const bool inside = x >= 16 && x < 48 && y >= 16 && y < 48;
      for (int c = 0; c < 3; ++c) {
        state = state * 1664525 + 1013904223;
        const int wander = noise == 0 ? 0 : int(state >> 16) % (2 * noise + 1) - noise;
        image.data.push_back(std::uint8_t(inside ? square : 128 + wander));
      }
    }
  return image;
}

std::ptrdiff_t object_pixels(const Image& image, Background background = Background::kCertain) {
  const auto object = object_outline(image, background);
  return std::count(object.begin(), object.end(), 1);
}

TEST(ObjectOutline, BeforeAPlainBackgroundAFewLevelsTellTheObject) {
  EXPECT_EQ(object_pixels(photograph(136, 0)), kObjectPixels);
  EXPECT_EQ(object_pixels(photograph(132, 0)), 0) << "as like as JPEG leaves a background";
  EXPECT_EQ(object_pixels(photograph(136, 0), Background::kLikely), 0) << "a soft shadow";
}

TEST(ObjectOutline, NoiseOfTheBackgroundIsNoObject) {
  EXPECT_EQ(object_pixels(photograph(160, 5)), kObjectPixels);
  EXPECT_EQ(object_pixels(photograph(136, 5)), 0) << "no farther off than noise is";
}

}  // namespace
}  // namespace slf::object_outline_test
