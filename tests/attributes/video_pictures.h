// SPDX-License-Identifier: Apache-2.0
// Pictures that are something to predict, and what is left of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <ostream>
#include <vector>

#include "attributes/video/encoder/hevc_encoder.h"
#include "attributes/video/picture.h"
#include "video_support.h"

namespace slf::test {

using Bytes = std::vector<std::uint8_t>;

/// What a decoder gave.
struct Decoded {
  Result<Done> result = Done{};
  std::vector<Picture> pictures;
};

/// Waves that move from picture to picture, and some noise: something to predict, and a rest.
inline Picture test_picture(const VideoFormat& format, std::size_t index) {
  Picture picture = blank_picture(format.width, format.height, format.bits, format.chroma);
  const double half = (1 << format.bits) / 2.0;
  std::uint32_t noise = static_cast<std::uint32_t>(index) * 977u + 1u;
  for (int plane = 0; plane < num_planes(format.chroma); ++plane) {
    const auto width = static_cast<std::size_t>(plane_size(format.width, format.chroma, plane));
    auto& samples = picture.planes[static_cast<std::size_t>(plane)];
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const std::size_t column = i % width, row = i / width;
      const double x = static_cast<double>(column) + 2.0 * static_cast<double>(index);
      const auto y = static_cast<double>(row);
      noise = noise * 1664525u + 1013904223u;
      const double value = half + 0.6 * half * std::sin(0.11 * x + plane) * std::cos(0.07 * y) +
                           half / 64 * (noise >> 24) / 256;
      samples[i] = static_cast<std::uint16_t>(value);
    }
  }
  return picture;
}

/// dB, over all samples of all planes and pictures.
inline double psnr(const std::vector<Picture>& pictures, const VideoFormat& format) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const Picture original = test_picture(format, i);
    for (std::size_t plane = 0; plane < original.planes.size(); ++plane)
      for (std::size_t s = 0; s < original.planes[plane].size(); ++s) {
        const double d = pictures[i].planes[plane][s] - double{1} * original.planes[plane][s];
        sum += d * d;
        count += 1;
      }
  }
  const double peak = (1 << format.bits) - 1;
  return 10 * std::log10(peak * peak * count / sum);
}

struct VideoCase {
  const char* name;
  VideoFormat format;
  HevcMode mode;
};
inline void PrintTo(const VideoCase& video, std::ostream* out) { *out << video.name; }

inline constexpr auto kIntra = HevcMode::kIntra, kLow = HevcMode::kLowDelay;
inline constexpr auto k400 = ChromaFormat::k400, k420 = ChromaFormat::k420,
                      k444 = ChromaFormat::k444;

inline constexpr VideoFormat kSmall{80, 72, 8, k400, 4};

}  // namespace slf::test
