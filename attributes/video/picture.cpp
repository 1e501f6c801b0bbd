// SPDX-License-Identifier: Apache-2.0
#include "attributes/video/picture.h"

#include <algorithm>
#include <string>

namespace slf {

Picture blank_picture(int width, int height, int bits, ChromaFormat chroma) {
  Picture picture{width, height, bits, chroma, {}};
  for (int plane = 0; plane < num_planes(chroma); ++plane)
    picture.planes.emplace_back(static_cast<std::size_t>(plane_size(width, chroma, plane)) *
                                static_cast<std::size_t>(plane_size(height, chroma, plane)));
  return picture;
}

bool is_sound(const VideoFormat& f) {
  constexpr int kMostSize = 8192;
  const bool even = f.chroma != ChromaFormat::k420 || (f.width % 2 == 0 && f.height % 2 == 0);
  return f.width >= 1 && f.width <= kMostSize && f.height >= 1 && f.height <= kMostSize && even &&
         (f.bits == 8 || f.bits == 10 || f.bits == 12) && f.pictures >= 1;
}

Result<Done, InputError> check_picture(const Picture& p, const VideoFormat& video) {
  constexpr int kLeastSize = 16;  // x265: a coding tree unit; libaom: the same for equal behaviour
  const auto invalid = [](const std::string& what) {
    return InputError{Errc::kInvalidArgument, "video encoding: " + what};
  };
  if (!is_sound(video) || std::min(video.width, video.height) < kLeastSize)
    return invalid(std::to_string(video.width) + " x " + std::to_string(video.height) +
                   " samples of " + std::to_string(video.bits) +
                   " bits; 16 to 8192 are possible, even with 4:2:0, of 8, 10 or 12 bits");
  if (p.width != video.width || p.height != video.height || p.bits != video.bits ||
      p.chroma != video.chroma)
    return invalid("pictures differ in size, depth or chroma");
  const Picture blank = blank_picture(p.width, p.height, p.bits, p.chroma);
  if (p.planes.size() != blank.planes.size()) return invalid("planes do not fit the chroma format");
  for (std::size_t i = 0; i < p.planes.size(); ++i) {
    if (p.planes[i].size() != blank.planes[i].size()) return invalid("a plane's size is wrong");
    for (const std::uint16_t sample : p.planes[i])
      if (sample >> p.bits != 0) return invalid("a sample is beyond its bits");
  }
  return Done{};
}

}  // namespace slf
