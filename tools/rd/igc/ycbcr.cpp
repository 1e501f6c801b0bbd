// SPDX-License-Identifier: Apache-2.0
#include "tools/rd/igc/ycbcr.h"

#include <algorithm>
#include <cmath>

namespace slf {
namespace {

// ITU-R BT.709, clause 3: luma weights; differences scaled to -1/2 .. 1/2.
constexpr double kRed = 0.2126, kGreen = 0.7152, kBlue = 0.0722;
constexpr double kCbScale = 2 * (1 - kBlue), kCrScale = 2 * (1 - kRed);
constexpr double kMiddle = 128;

std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

std::size_t at(int x, int y, int width) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
         static_cast<std::size_t>(x);
}

/// Colour difference of 4:2:0, its samples in the middle of 2 x 2 pixels, at a pixel: bilinear.
double chroma_at(const std::vector<std::uint16_t>& plane, int width, int height, int x, int y) {
  const int near_x = x / 2, near_y = y / 2;
  const int far_x = std::clamp(x % 2 == 0 ? near_x - 1 : near_x + 1, 0, width - 1);
  const int far_y = std::clamp(y % 2 == 0 ? near_y - 1 : near_y + 1, 0, height - 1);
  return (9 * plane[at(near_x, near_y, width)] + 3 * plane[at(far_x, near_y, width)] +
          3 * plane[at(near_x, far_y, width)] + plane[at(far_x, far_y, width)]) /
         16.0;
}

}  // namespace

VideoFormat video_format(int width, int height, IgcChroma chroma, std::size_t pictures) {
  if (chroma == IgcChroma::k444) return {width, height, 8, ChromaFormat::k444, pictures};
  return {width + width % 2, height + height % 2, 8, ChromaFormat::k420, pictures};
}

Picture to_ycbcr(const Image& image, IgcChroma chroma) {
  const VideoFormat format = video_format(image.width, image.height, chroma, 1);
  Picture picture = blank_picture(format.width, format.height, format.bits, format.chroma);
  const int block = format.chroma == ChromaFormat::k420 ? 2 : 1;
  std::vector<double> cb(picture.planes[1].size()), cr(picture.planes[1].size());
  for (int y = 0; y < format.height; ++y)
    for (int x = 0; x < format.width; ++x) {
      const std::size_t pixel =
          at(std::min(x, image.width - 1), std::min(y, image.height - 1), image.width);
      const std::uint8_t* rgb = &image.data[pixel * static_cast<std::size_t>(image.channels)];
      const double luma = kRed * rgb[0] + kGreen * rgb[1] + kBlue * rgb[2];
      picture.planes[0][at(x, y, format.width)] = to_byte(luma);
      const std::size_t to = at(x / block, y / block, format.width / block);
      cb[to] += (rgb[2] - luma) / kCbScale / (block * block);
      cr[to] += (rgb[0] - luma) / kCrScale / (block * block);
    }
  for (std::size_t i = 0; i < cb.size(); ++i) {
    picture.planes[1][i] = to_byte(cb[i] + kMiddle);
    picture.planes[2][i] = to_byte(cr[i] + kMiddle);
  }
  return picture;
}

Image to_rgb(const Picture& picture, int width, int height) {
  Image image{width, height, 3, {}};
  image.data.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  const bool halved = picture.chroma == ChromaFormat::k420;
  const auto difference = [&](std::size_t plane, int x, int y) {
    const auto& samples = picture.planes[plane];
    if (!halved) return samples[at(x, y, picture.width)] - kMiddle;
    return chroma_at(samples, picture.width / 2, picture.height / 2, x, y) - kMiddle;
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double luma = picture.planes[0][at(x, y, picture.width)];
      const double blue = luma + kCbScale * difference(1, x, y);
      const double red = luma + kCrScale * difference(2, x, y);
      const double green = (luma - kRed * red - kBlue * blue) / kGreen;
      for (const double value : {red, green, blue}) image.data.push_back(to_byte(value));
    }
  return image;
}

}  // namespace slf
