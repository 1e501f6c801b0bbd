// SPDX-License-Identifier: Apache-2.0
// The one place that includes libaom: AV1, for image-plus-geometry files alone (SLF_AV1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "attributes/video/picture.h"
#include "slf/error.h"

namespace slf {

struct Av1Settings {
  int cq_level = 32;        ///< 0 .. 63, constant quality; coarser is larger
  int cpu_used = 4;         ///< 0 .. 8: slow and small to fast and larger
  bool intra_only = false;  ///< every picture by itself; else the first is, and no other
};

/// Codes pictures as AV1 temporal units, one per picture, each after its length in 4 bytes, little
/// endian. Pictures are coded out of order where that is smaller (alternative references, 48
/// ahead).
/// @param source  as encode_hevc has it
/// @errors kInvalidArgument: a setting or a picture out of range. kUnsupported: this build has no
///         libaom. kLimitExceeded: libaom gave up.
/// One thread, so that the bytes are the same everywhere.
Result<std::vector<std::uint8_t>, InputError> encode_av1(
    std::size_t pictures, const std::function<Picture(std::size_t)>& source,
    const Av1Settings& settings);

/// @param sink  called with 0, 1, ... and the pictures in display order
/// @errors kTruncated, kOutOfRange: lengths, a sequence header of another size than expected or
///         that changes, more coded frames than two per picture (one may be hidden), damage that
///         libaom notices. kUnsupported: this build has no libaom.
Result<Done> decode_av1(std::span<const std::uint8_t> stream, const VideoFormat& expected,
                        const std::function<void(std::size_t, const Picture&)>& sink);

}  // namespace slf
