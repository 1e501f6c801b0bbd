// SPDX-License-Identifier: Apache-2.0
// Photographs that are read smaller than they are, and those that are kept.
#include "capture/image_reduction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "capture/image_cache.h"
#include "capture/image_formats.h"
#include "capture_support.h"
#include "slf/jpeg.h"

namespace slf::image_reduction_test {
namespace {

Image gradient(int width, int height, int channels) {
  Image image{width, height, channels, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c)
        image.data.push_back(static_cast<std::uint8_t>(x * 3 + y * 2 + c * 10));
  return image;
}

TEST(ImageReduction, PixelsAreMeansAndAlphaTheLeast) {
  Image image{3, 3, 4, {}};
  for (int i = 0; i < 9; ++i)
    for (const int value : {10 * i, 100, 255 - i, i == 4 ? 0 : 255})
      image.data.push_back(static_cast<std::uint8_t>(value));
  const Image half = reduced(image, 1);
  EXPECT_EQ(half.width, 2);
  EXPECT_EQ(half.height, 2);
  EXPECT_EQ(half.data[0], (0 + 10 + 30 + 40) / 4);
  EXPECT_EQ(half.data[1], 100);
  EXPECT_EQ(half.data[3], 0);              // one of the four is masked
  EXPECT_EQ(half.data[4], (20 + 50) / 2);  // at the border of those that there are
  EXPECT_EQ(half.data[7], 255);
  EXPECT_EQ(reduced_mask(image, 1).data[0], 0);
  EXPECT_EQ(reduced(image, 0).data, image.data);
  EXPECT_EQ(reduced(image, 2).data.size(), 4u);
}

TEST(ImageReduction, AReducedCameraSeesTheSamePlaces) {
  Camera camera;
  camera.width = 401;
  camera.height = 300;
  camera.fx = camera.fy = 350;
  camera.cx = 199;
  camera.cy = 151;
  camera.distortion = {0.05, 0.01, 0.001, -0.002};
  const Camera small = reduced(camera, 2);
  EXPECT_EQ(small.width, 101);
  EXPECT_EQ(small.height, 75);
  const Vec3 at{0.2, -0.1, 1.5};
  const auto whole = camera.project(at), part = small.project(at);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR((*whole)[k], 4 * (*part)[k], 1e-9);
}

TEST(ImageReduction, AJpegIsDecodedToNearlyTheMeans) {
  const Image image = gradient(67, 45, 3);
  const auto bytes = *encode_jpeg(image, 95);
  ImageSize size;
  const auto whole = decode_jpeg("x.jpg", bytes, 0, size);
  ASSERT_TRUE(whole) << whole.error().message;
  for (int log2 = 1; log2 <= kMostJpegReduction; ++log2) {
    const auto small = decode_jpeg("x.jpg", bytes, log2, size);
    ASSERT_TRUE(small) << small.error().message;
    EXPECT_EQ(size.width, 67u);
    const Image means = reduced(*whole, log2);
    ASSERT_EQ(small->width, means.width);
    ASSERT_EQ(small->height, means.height);
    double squared = 0;
    for (std::size_t i = 0; i < means.data.size(); ++i)
      squared += std::pow(double(small->data[i]) - double(means.data[i]), 2);
    EXPECT_LT(std::sqrt(squared / double(means.data.size())), 6) << log2;
  }
}

TEST(ImageReduction, LoadsPhotographsOfTheSizeThatTheCameraHas) {
  const test::TemporaryDirectory directory;
  Capture capture;
  capture.root = directory / "";
  ASSERT_TRUE(write_png(directory / "a.png", gradient(50, 30, 3)));
  Image mask{50, 30, 3, std::vector<std::uint8_t>(std::size_t{50} * 30 * 3, 255)};
  for (std::size_t c = 0; c < 3; ++c) mask.data[c] = 0;
  ASSERT_TRUE(write_png(directory / "m.png", mask));
  Camera camera;
  camera.name = "a";
  camera.width = 50;
  camera.height = 30;
  capture.cameras = {reduced(camera, 1)};
  capture.image_files = {directory / "a.png"};
  capture.mask_files = {directory / "m.png"};
  capture.reduction = {1};
  capture.cache = std::make_shared<ImageCache>(1 << 20);
  const auto image = load_image(capture, 0);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->width, 25);
  EXPECT_EQ(image->data[3], 0);
  EXPECT_EQ(image->data[7], 255);
  std::filesystem::remove(directory / "a.png");
  EXPECT_EQ(load_image(capture, 0)->data, image->data);  // kept
  capture.cache = nullptr;
  EXPECT_FALSE(load_image(capture, 0));
  capture.images = {gradient(50, 30, 3)};
  EXPECT_EQ(load_image(capture, 0)->width, 25);
  capture.reduction = {2};
  EXPECT_FALSE(load_image(capture, 0));  // not the camera's
}

TEST(ImageCache, KeepsWhatWasAskedForLastWithinItsBytes) {
  const auto image = std::make_shared<const Image>(gradient(10, 10, 3));  // 300 bytes
  ImageCache cache(700);
  cache.keep(0, image);
  cache.keep(1, image);
  EXPECT_TRUE(cache.find(0));
  cache.keep(2, image);
  EXPECT_TRUE(cache.find(0));
  EXPECT_FALSE(cache.find(1));
  EXPECT_TRUE(cache.find(2));
  cache.keep(3, std::make_shared<const Image>(gradient(20, 20, 3)));  // larger than all
  EXPECT_FALSE(cache.find(3));
  EXPECT_TRUE(cache.find(2));
  ImageCache none(0);
  none.keep(0, image);
  EXPECT_FALSE(none.find(0));
}

}  // namespace
}  // namespace slf::image_reduction_test
