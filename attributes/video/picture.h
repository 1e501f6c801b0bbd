// SPDX-License-Identifier: Apache-2.0
// A picture as video codecs take it: planes of integer samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "slf/error.h"

namespace slf {

/// As chroma_format_idc of HEVC has it.
enum class ChromaFormat : std::uint8_t {
  k400 = 0,  ///< one plane
  k420 = 1,  ///< chroma planes of half the width and height, both even
  k444 = 3,
};

inline int num_planes(ChromaFormat chroma) { return chroma == ChromaFormat::k400 ? 1 : 3; }

/// Width, or height, of a plane where the picture's is `size`.
inline int plane_size(int size, ChromaFormat chroma, int plane) {
  return plane > 0 && chroma == ChromaFormat::k420 ? size / 2 : size;
}

struct Picture {
  int width = 0, height = 0;  ///< of plane 0
  int bits = 8;               ///< 8, 10 or 12 per sample
  ChromaFormat chroma = ChromaFormat::k400;
  std::vector<std::vector<std::uint16_t>> planes;  ///< rows top to bottom, no padding
};

/// A picture of samples 0.
Picture blank_picture(int width, int height, int bits, ChromaFormat chroma);

/// What a coded video has to hold. The caller checks the product against its limits.
struct VideoFormat {
  int width = 0, height = 0;  ///< 1 .. 8192
  int bits = 8;               ///< 8, 10 or 12, all planes
  ChromaFormat chroma = ChromaFormat::k400;
  std::size_t pictures = 0;  ///< >= 1
};

/// Within the ranges above; even sizes for 4:2:0.
bool is_sound(const VideoFormat& format);

/// That an encoder can take a picture as one of a video.
/// @errors kInvalidArgument: smaller than 16 x 16, not sound, not of the video's format, planes of
///         another size, samples beyond the depth.
Result<Done, InputError> check_picture(const Picture& picture, const VideoFormat& video);

}  // namespace slf
