// SPDX-License-Identifier: Apache-2.0
// The one place that includes x265: HEVC encoding. x265 is GPL, so it is a component of its own
// (SLF_X265, target slf_x265) that is off unless asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "attributes/video/picture.h"
#include "slf/error.h"

namespace slf {

enum class HevcMode : std::uint8_t {
  kIntra,     ///< every picture by itself
  kLowDelay,  ///< the first by itself, then forward prediction in coded order = output order
};

struct HevcSettings {
  int qp = 32;  ///< 0 .. 51; 4 at 8 bit is about a step of 1. The first picture of kLowDelay, from
                ///< which all others are predicted, is coded 3 finer
  HevcMode mode = HevcMode::kLowDelay;
  std::string preset = "medium";  ///< of x265: ultrafast superfast veryfast faster fast medium slow
                                  ///< slower veryslow
  bool lossless = false;          ///< the decoder gets the very samples; qp is not used
};

/// Codes pictures as one HEVC Annex B byte stream: one VPS, SPS and PPS, then a slice each; no SEI.
/// Encoder decisions maximise PSNR at constant QP.
/// @param source  called once for each of 0 .. pictures-1, in order, on this thread. All have the
///                size, depth and chroma format of the first; 16 x 16 .. 8192 x 8192; even for
///                4:2:0.
/// @return kIntra, and kLowDelay with ultrafast or superfast: the same bytes on any number of
/// cores.
///         In predicted pictures of slower presets x265 3.5 decides by memory that it has not set
///         (valgrind), so that small pictures, above all, may come out otherwise the next time.
/// @errors kInvalidArgument: no pictures, or a setting or a picture outside the above.
///         kUnsupported: this build has no x265. kLimitExceeded: x265 gave up.
/// Thread-safe. Runs one coding thread; memory: a few pictures.
Result<std::vector<std::uint8_t>, InputError> encode_hevc(
    std::size_t pictures, const std::function<Picture(std::size_t)>& source,
    const HevcSettings& settings);

}  // namespace slf
