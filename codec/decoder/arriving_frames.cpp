// SPDX-License-Identifier: Apache-2.0
#include "codec/decoder/arriving_frames.h"

#include <algorithm>
#include <utility>

namespace slf {
namespace {

/// Sequence and frame unit of a sound frame: a lattice of 2^18 vectors at the most. One that says
/// that it is longer is taken for damaged when so much of it has come.
constexpr std::size_t kMostHead = std::size_t{1} << 22;
/// Seconds from a frame to a lost one where no others tell.
constexpr double kUsualInterval = 1.0 / 30;

FrameInfo info_of(const FrameUnits& frame, std::uint64_t offset) {
  return {frame.header.frame_number, frame.header.frame_time, frame.header.predicted(), offset,
          frame.bytes};
}

Error moved_by(Error error, std::uint64_t offset) {
  if (has_place(error)) error.bit_offset += 8 * offset;
  return error;
}

Error wrong_frame(const FrameUnits& frame, const char* element) {
  return of_unit(UnitType::kFrame, frame.unit.offset, Errc::kOutOfRange, element);
}

}  // namespace

Result<Done> ArrivingFrames::push(std::span<const std::uint8_t> bytes) {
  if (failed_) return *failed_;
  pending_.insert(pending_.end(), bytes.begin(), bytes.end());
  return take_frames();
}

Result<Done> ArrivingFrames::finish() {
  if (failed_) return *failed_;
  finished_ = true;
  SLF_CHECK(take_frames());
  if (infos_.empty()) return Error{Errc::kTruncated, "signature", 8 * offset()};
  return Done{};
}

void ArrivingFrames::begin_at(std::size_t place) {
  for (std::size_t i = 0; i < frames_.size(); ++i) drop(i);
  pending_ = {};
  at_ = 0;
  needed_ = 0;
  looking_.reset();
  looked_to_ = 0;
  finished_ = false;
  next_ = place;
  pending_offset_ = infos_[place].offset;
}

void ArrivingFrames::drop(std::size_t place) {
  held_ -= frames_[place].bytes.size();
  frames_[place].bytes = {};
}

/// Whole frames leave `pending_`, which then begins with what is left.
Result<Done> ArrivingFrames::take_frames() {
  for (bool more = true; more;) {
    const auto taken = take_next();
    if (!taken) {
      failed_ = moved_by(taken.error(), offset());
      return *failed_;
    }
    more = *taken;
  }
  leave_taken();
  return Done{};
}

void ArrivingFrames::leave_taken() {
  pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(at_));
  pending_offset_ += at_;
  at_ = 0;
}

/// @return whether there may be another. Errors count from rest()
Result<bool> ArrivingFrames::take_next() {
  if (looking_) return find_intra();
  if (rest().empty() || (rest().size() < needed_ && !finished_)) return false;
  return next_ == 0 ? take_first() : take_frame();
}

Result<bool> ArrivingFrames::take_first() {
  if (moves(rest())) return take_frame();
  const std::size_t known = std::min(rest().size(), kSignature.size());
  if (!std::equal(kSignature.begin(), kSignature.begin() + static_cast<std::ptrdiff_t>(known),
                  rest().begin()))
    return Error{Errc::kNotSlf, "signature"};
  if (!finished_) return false;  // one light field, or too few bytes to tell
  SLF_TRY(const auto units, split_units(rest(), 0, DecodeLimits{}.max_memory));
  ArrivedFrame frame;
  frame.units.bytes = rest().size();
  frame.bytes.assign(rest().begin(), rest().end());
  const FrameInfo info = info_of(frame.units, offset());
  SLF_CHECK(add(info, std::move(frame)));
  return false;
}

Result<bool> ArrivingFrames::take_frame() {
  const auto frame = read_frame(rest(), 0);
  if (!frame && frame.error().code == Errc::kTruncated && !finished_ && rest().size() < kMostHead)
    return false;
  if (!frame && next_ == 0) return frame.error();
  if (!frame) return lose(frame.error());
  const auto ordered = check_order(*frame);
  if (!ordered) return lose(ordered.error());
  needed_ = frame->end();
  if (rest().size() < needed_ && !finished_) return false;
  ArrivedFrame own;
  const auto bytes = rest().first(static_cast<std::size_t>(frame->bytes));
  own.bytes.assign(bytes.begin(), bytes.end());
  SLF_TRY(own.units, read_frame(own.bytes, 0));
  const FrameInfo info = info_of(own.units, offset());
  SLF_CHECK(add(info, std::move(own)));
  return true;
}

Result<Done> ArrivingFrames::check_order(const FrameUnits& frame) const {
  if (next_ == 0) return Done{};
  const FrameInfo& before = infos_[next_ - 1];
  if (frame.header.frame_number != before.number + 1) return wrong_frame(frame, "frame_number");
  if (frame.header.frame_time <= before.time) return wrong_frame(frame, "frame_time");
  return Done{};
}

/// From here on no frame can be read until an intra frame begins: perhaps within the bytes that the
/// frame before took, where some of its own are missing. Bytes are looked at twice at most.
Result<bool> ArrivingFrames::lose(const Error& error) {
  looking_ = moved_by(error, offset());
  looking_from_ = offset();
  const FrameInfo& before = infos_[next_ - 1];
  const std::vector<std::uint8_t>& bytes = frames_[next_ - 1].bytes;
  if (before.offset < looked_to_ || bytes.empty()) return true;
  leave_taken();
  looked_to_ = before.offset + before.bytes;
  pending_.insert(pending_.begin(), bytes.begin() + 1, bytes.end());
  pending_offset_ -= bytes.size() - 1;
  return true;
}

/// The next intra frame that is later than the frames before.
Result<bool> ArrivingFrames::find_intra() {
  const auto bytes = rest();
  const auto found = std::search(bytes.begin(), bytes.end(), kSignature.begin(), kSignature.end());
  if (found == bytes.end()) {
    const std::size_t begun = finished_ ? 0 : std::min(bytes.size(), kSignature.size() - 1);
    at_ = pending_.size() - begun;
    if (finished_) SLF_CHECK(add_rest());
    return false;
  }
  at_ += static_cast<std::size_t>(found - bytes.begin());
  const auto frame = read_frame(rest(), 0);
  if (!frame && frame.error().code == Errc::kTruncated && !finished_ && rest().size() < kMostHead)
    return false;
  const FrameInfo& before = infos_[next_ - 1];
  if (!frame || frame->header.frame_number <= before.number ||
      frame->header.frame_time <= before.time) {
    ++at_;
    return true;
  }
  if (frame->header.frame_number > before.number + 1) SLF_CHECK(add_lost(frame->header));
  looking_.reset();
  needed_ = 0;
  return true;
}

/// What stands for the frames before the one that was found.
Result<Done> ArrivingFrames::add_lost(const FrameHeader& found) {
  const double time = infos_[next_ - 1].time;
  const std::uint64_t from = std::min(looking_from_, offset());
  ArrivedFrame none;
  none.lost = looking_;
  return add({found.frame_number - 1, time + (found.frame_time - time) / 2, true, from,
              offset() - from, true},
             std::move(none));
}

/// The stream ends, and no intra frame was found. Less than the units that a frame begins with is
/// what was cut off, and no frame.
Result<Done> ArrivingFrames::add_rest() {
  ArrivedFrame none;
  none.lost = std::exchange(looking_, std::nullopt);
  if (none.lost->code == Errc::kTruncated) return Done{};
  const FrameInfo& last = infos_[next_ - 1];
  const double interval = next_ > 1 ? last.time - infos_[next_ - 2].time : kUsualInterval;
  return add(
      {last.number + 1, last.time + interval, true, looking_from_, offset() - looking_from_, true},
      std::move(none));
}

/// Adds a frame whose place is known already: the same as before, with its bytes.
Result<Done> ArrivingFrames::add(const FrameInfo& info, ArrivedFrame frame) {
  at_ += frame.bytes.size();
  needed_ = 0;
  held_ += frame.bytes.size();
  if (next_ == infos_.size()) {
    infos_.push_back(info);
    frames_.push_back(std::move(frame));
  } else if (infos_[next_].number != info.number || infos_[next_].offset != info.offset) {
    return Error{Errc::kOutOfRange, "frame_number", 0, unit_name(UnitType::kFrame)};
  } else {
    frames_[next_] = std::move(frame);
  }
  ++next_;
  return Done{};
}

}  // namespace slf
