// SPDX-License-Identifier: Apache-2.0
// JPEG out: previews, read back by the reader of captures.
#include "slf/jpeg.h"

#include <gtest/gtest.h>

#include <cmath>

#include "capture_support.h"

namespace slf::jpeg_test {
namespace {

Image ramp(int width, int height) {
  Image image{width, height, 3, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const int value : {255 * x / width, 255 * y / height, 128})
        image.data.push_back(static_cast<std::uint8_t>(value));
  return image;
}

/// dB, after writing and reading.
double psnr_after(const Image& image, int quality) {
  const test::TemporaryDirectory directory;
  const auto bytes = encode_jpeg(image, quality);
  EXPECT_TRUE(bytes);
  const auto file = directory.path() / "picture.jpg";
  EXPECT_TRUE(write_file(file, bytes->data(), bytes->size()));
  const auto back = read_image(file);
  EXPECT_TRUE(back);
  EXPECT_EQ(back->width, image.width);
  EXPECT_EQ(back->height, image.height);
  double sum = 0;
  for (std::size_t i = 0; i < image.data.size(); ++i)
    sum += std::pow(double(image.data[i]) - double(back->data[i]), 2);
  return 10 * std::log10(255.0 * 255.0 * double(image.data.size()) / sum);
}

TEST(Jpeg, APictureIsReadBackAsItWasAndBetterWithMoreQuality) {
  const Image image = ramp(61, 43);
  EXPECT_GT(psnr_after(image, 90), 35);
  EXPECT_GT(psnr_after(image, 90), psnr_after(image, 20) + 3);
}

TEST(Jpeg, TheSmallestPicture) { EXPECT_GT(psnr_after(Image{1, 1, 3, {10, 200, 90}}, 95), 30); }

TEST(Jpeg, WhatIsNoRgbImageOrNoQualityIsRefused) {
  for (const Image& image : {Image{}, Image{2, 1, 3, {1, 2, 3}}, Image{1, 1, 4, {1, 2, 3, 4}},
                             Image{20000, 1, 3, std::vector<std::uint8_t>(60000)}})
    EXPECT_FALSE(encode_jpeg(image, 80));
  EXPECT_FALSE(encode_jpeg(ramp(4, 4), 0));
  EXPECT_FALSE(encode_jpeg(ramp(4, 4), 101));
}

}  // namespace
}  // namespace slf::jpeg_test
