// Where the frames of a stream are. Spec 7.13.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/units.h"
#include "codec/frame_header.h"
#include "slf/error.h"

namespace slf {

/// A frame in its stream.
struct FrameUnits {
  FrameHeader header;                          ///< its lattice is still to be read
  std::span<const std::uint8_t> vectors;       ///< of the lattice
  Unit unit;                                   ///< the frame unit; of one frame alone: none
  std::uint64_t offset = 0, bytes = 0;         ///< of the frame, cut at the end of the stream
};

/// The frame that begins at `at`. Of an intra frame the frame unit follows the sequence unit.
Result<FrameUnits> read_frame(std::span<const std::uint8_t> stream, std::size_t at);

/// @errors those of slf::list_frames
Result<std::vector<FrameUnits>> split_frames(std::span<const std::uint8_t> stream);

/// The first frame of a stream: all of it where it does not move.
/// @errors those of its frame unit
Result<std::span<const std::uint8_t>> first_frame(std::span<const std::uint8_t> stream);

/// The units of a predicted frame.
/// @errors those of units; kOutOfRange: one that such a frame does not have
Result<Units> predicted_units(std::span<const std::uint8_t> stream, const FrameUnits& frame);

}  // namespace slf
