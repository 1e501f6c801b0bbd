// SPDX-License-Identifier: Apache-2.0
// Any frame of a list: those before it that it needs, and it. Spec 8.12.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "codec/decoder/frame_chain.h"
#include "slf/frames.h"

namespace slf {

/// The intra frame that the group of `frame` begins with; a lost frame is a group of its own.
inline std::size_t group_of(const std::vector<FrameInfo>& frames, std::size_t frame) {
  while (frames[frame].predicted && !frames[frame].lost) --frame;
  return frame;
}

/// Where a frame's bytes are.
struct FrameBytes {
  std::span<const std::uint8_t> bytes;  ///< `units` counts from their first
  const FrameUnits* units = nullptr;
  std::uint64_t begin = 0;  ///< of the first of these bytes in the stream that errors are of
};

class FrameWalk {
 public:
  /// @param find  the bytes of a place, or why there are none
  /// @errors kInvalidArgument: no such place; those of `find` and of FrameChain
  Result<LightField> decode(const std::vector<FrameInfo>& frames, std::size_t frame,
                            const DecodeOptions& options,
                            const std::function<Result<FrameBytes>(std::size_t)>& find) {
    if (frame >= frames.size()) return Error{Errc::kInvalidArgument, "frame"};
    std::size_t next = group_of(frames, frame);
    if (at_ && *at_ >= next && *at_ < frame) next = *at_ + 1;
    for (; next < frame; ++next) SLF_CHECK(decode_next(next, options, find));
    return decode_next(frame, options, find);
  }

  /// What was decoded last is of no use any more, if it stands before `frame`.
  void forget_before(std::size_t frame) {
    if (at_ && *at_ < frame) *this = {};
  }

 private:
  Result<LightField> decode_next(std::size_t place, const DecodeOptions& options,
                                 const std::function<Result<FrameBytes>(std::size_t)>& find) {
    at_.reset();
    SLF_TRY(const FrameBytes found, find(place));
    auto field = chain_.decode(found.bytes, *found.units, options, found.begin);
    if (field) at_ = place;
    return field;
  }

  FrameChain chain_;
  std::optional<std::size_t> at_;  // place of the frame that was decoded last
};

}  // namespace slf
