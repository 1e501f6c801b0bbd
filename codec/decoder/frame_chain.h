// SPDX-License-Identifier: Apache-2.0
// Frames one after the other, each from the state that the one before has left. Spec 8.12.
#pragma once

#include <optional>
#include <span>

#include "codec/decoder/request.h"
#include "codec/frame_state.h"
#include "codec/split_frames.h"
#include "slf/decoder.h"

namespace slf {

/// A predicted frame behind the sequence and the transforms of its group.
/// @param max_memory  DecodeLimits::max_memory
/// @errors kOutOfRange: frame_predicted_flag behind a frame without points; those of
/// predicted_units
///         and collect_units
Result<OpenStream> open_predicted(std::span<const std::uint8_t> stream, const FrameUnits& frame,
                                  const OpenStream& group, std::uint64_t max_memory);

class FrameChain {
 public:
  /// @param stream  bytes that `frame` is in. Those of an intra frame stay until its group is done
  /// @param frame   the next, or one that is not predicted
  /// @param begins  where the stream that errors are of has the first of these bytes
  /// @errors as slf::decode. Behind it comes a frame that is not predicted
  Result<LightField> decode(std::span<const std::uint8_t> stream, const FrameUnits& frame,
                            const DecodeOptions& options, std::uint64_t begins = 0);
  /// What the frame that was decoded last leaves.
  const FrameState& state() const { return state_; }

 private:
  Result<LightField> decode_intra(std::span<const std::uint8_t> stream, const FrameUnits& frame,
                                  const DecodeOptions& options, FrameState& kept);
  Result<LightField> decode_predicted(std::span<const std::uint8_t> stream, const FrameUnits& frame,
                                      const DecodeOptions& options, FrameState& kept);
  Result<Done> check_moves(const FrameUnits& frame, const SequenceParameterSet& set,
                           const DecodeLimits& limits) const;

  std::optional<OpenStream> group_;      // the frame that others of its group go back to
  std::uint64_t group_offset_ = 0;       // of its first byte in the stream that errors are of
  bool error_is_of_group_ = false;       // counts from there, not from the bytes given
  std::optional<GroupRequest> request_;  // what it was asked for
  FrameState state_;
  double time_ = 0;  // of the frame that was decoded last, in seconds
};

}  // namespace slf
