// SPDX-License-Identifier: Apache-2.0
// Streams with less in them, without decoding and coding again.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slf/decoder.h"
#include "slf/error.h"

namespace slf {

/// Leaves out units that options.levels, groups, layers and region do not need, marks the stream as
/// cut and writes its index anew. decode() of the result, with the same options, gives what
/// decode() of the stream gives with them; without options the same for levels, groups and layers,
/// and of a region all of the slices that meet it. It is never longer than the stream: an index is
/// left out that would make it so, and the stream comes back as it was, not marked, where nothing
/// is left out, or less than what says that it is cut.
/// @param options  max_bytes > 0: as many of the units that remain as fit into a file of so many
///                 bytes; they come coarse first. limits: of the decode of what is asked for,
///                 whatever max_bytes. threads: those of that decode. seconds: not used
/// Each frame of a stream of several is cut (truncate_frames in slf/frames.h).
/// Thread-safe. O(bytes); where a region is given, the geometry of the base is decoded.
/// @errors those of headers as decode; kInvalidArgument also where max_bytes has no room for the
///         headers
Result<std::vector<std::uint8_t>> truncate(std::span<const std::uint8_t> stream,
                                           const DecodeOptions& options);

}  // namespace slf
