// SPDX-License-Identifier: Apache-2.0
// Where the frames of a stream are. Spec 7.13.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/units.h"
#include "codec/frame_header.h"
#include "slf/error.h"
#include "slf/frames.h"

namespace slf {

/// A frame in its stream.
struct FrameUnits {
  FrameHeader header;                     ///< its lattice is still to be read
  std::span<const std::uint8_t> vectors;  ///< of the lattice
  Unit unit;                              ///< the frame unit; of one frame alone: none
  std::uint64_t offset = 0, bytes = 0;    ///< of the frame, cut at the end of the stream

  bool moves() const { return unit.bytes > 0; }
  /// Where it ends, as its frame unit says; the stream may end before.
  std::uint64_t end() const { return unit.offset + unit.bytes + header.frame_bytes; }
};

bool begins_intra(std::span<const std::uint8_t> rest);

/// Does a frame unit follow the sequence unit?
bool moves(std::span<const std::uint8_t> stream);

/// The frame that begins at `at`. Of an intra frame the frame unit follows the sequence unit.
Result<FrameUnits> read_frame(std::span<const std::uint8_t> stream, std::size_t at);

/// @param max_memory  of what is listed: frames, and units of a stream that is one frame
/// @errors those of slf::list_frames; kLimitExceeded: max_memory
Result<std::vector<FrameUnits>> split_frames(std::span<const std::uint8_t> stream,
                                             std::uint64_t max_memory = ~std::uint64_t{0});

/// The first frame of a stream: all of it where it does not move, or ends before that is told.
Result<FrameUnits> first_frame(std::span<const std::uint8_t> stream);

/// A frame that ends with its end unit has as many bytes as it says.
/// @errors kOutOfRange: frame_bytes
Result<Done> check_frame_bytes(const FrameUnits& frame, const Units& units);

/// The units of a predicted frame.
/// @errors those of units; kOutOfRange: one that such a frame does not have, frame_bytes;
///         kLimitExceeded: max_memory
Result<Units> predicted_units(std::span<const std::uint8_t> stream, const FrameUnits& frame,
                              std::uint64_t max_memory);

}  // namespace slf
