// SPDX-License-Identifier: Apache-2.0
// Bytes that come in pieces, cut into frames. Spec 7.13.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/decoder/arriving_units.h"
#include "codec/split_frames.h"
#include "slf/error.h"
#include "slf/frames.h"

namespace slf {

/// A frame with bytes of its own, which do not move while others come. Those of a light field that
/// does not move do, while there are more to come.
struct ArrivedFrame {
  FrameUnits units;  ///< counted from the first of the bytes
  std::vector<std::uint8_t> bytes;
  std::optional<Error> lost;  ///< why there is none
};

class ArrivingFrames {
 public:
  /// @errors of the first frame, for good
  Result<Done> push(std::span<const std::uint8_t> bytes);
  Result<Done> finish();
  /// What is pushed next begins with frame `place`.
  void begin_at(std::size_t place);

  const std::vector<FrameInfo>& infos() const { return infos_; }
  std::vector<ArrivedFrame>& frames() { return frames_; }
  const std::vector<ArrivedFrame>& frames() const { return frames_; }
  bool finished() const { return finished_; }
  std::uint64_t held_bytes() const { return held_ + pending_.size(); }
  void drop(std::size_t place);

 private:
  Result<Done> take_frames();
  void leave_taken();
  Result<bool> take_next();
  Result<bool> take_first();
  Result<bool> take_frame();
  Result<bool> take_units();
  bool lacks_head(const Result<FrameUnits>& frame);
  Result<bool> find_intra();
  Result<bool> lose(const Error& error);
  Result<Done> add(const FrameInfo& info, ArrivedFrame frame);
  Result<Done> add_lost(const FrameHeader& found);
  Result<Done> add_rest();
  Result<Done> check_order(const FrameUnits& frame) const;

  bool lists_units() const { return units_ && next_ > 0; }
  void fail(const Error& error);

  std::span<const std::uint8_t> rest() const { return std::span(pending_).subspan(at_); }
  std::uint64_t offset() const { return pending_offset_ + at_; }

  std::vector<FrameInfo> infos_;
  std::vector<ArrivedFrame> frames_;  // by place, as infos_
  std::size_t next_ = 0;              // place of the frame that comes
  std::vector<std::uint8_t> pending_;
  std::size_t at_ = 0;                  // of pending_: what is behind it belongs to frames
  std::uint64_t pending_offset_ = 0;    // of the first of pending_ in the stream
  std::uint64_t needed_ = 0;            // bytes of rest() that the frame takes, where known
  std::optional<ArrivingUnits> units_;  // of a light field that does not move
  std::optional<Error> looking_;        // for an intra frame, since this was found
  std::uint64_t looking_from_ = 0;      // in the stream
  std::uint64_t looked_to_ = 0;         // up to here frames were searched for others
  std::uint64_t held_ = 0;              // bytes of frames_
  bool finished_ = false;
  std::optional<Error> failed_;
};

}  // namespace slf
