// SPDX-License-Identifier: Apache-2.0
// What an HEVC byte stream says of itself, checked before a decoder sees it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "attributes/video/picture.h"
#include "slf/error.h"

namespace slf {

using HevcFormat = VideoFormat;

/// Cuts an Annex B byte stream into the NAL units that decoding needs, in order; access unit
/// delimiters, SEI and filler are left out. A decoder that is given no more than these cannot be
/// made to allocate or to work for more than `expected.pictures` pictures of the expected size.
/// @return NAL units with their two header bytes, without start codes; spans of `stream`
/// @errors kTruncated: an SPS ends early, or the stream has no NAL unit.
///         kOutOfRange: bytes outside NAL units; a unit type not of version 1 or of another layer;
///         an SPS whose size, chroma or depth is not the expected one, or with PCM blocks or
///         scaling lists; more pictures, or more parameter sets of a kind, than expected pictures;
///         a slice that refers to a picture that is not there.
/// Source: ITU-T H.265 clauses 7.3.1, 7.3.2.2, 8.3, B.2. O(stream).
Result<std::vector<std::span<const std::uint8_t>>> split_hevc(std::span<const std::uint8_t> stream,
                                                              const HevcFormat& expected);

}  // namespace slf
