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

/// Bytes with which one more of the sequence and frame unit is whole, of a frame that lacks one.
std::uint64_t end_of_next_head(std::span<const std::uint8_t> rest) {
  const bool intra = begins_intra(rest);
  if (!intra && rest[0] == kSignature[0]) return 0;  // the signature is not all there
  std::uint64_t end = intra ? kSignature.size() : 0;
  for (int unit = intra ? 0 : 1; unit < 2 && end <= rest.size(); ++unit) {
    const auto next = end_of_unit(rest, end);
    if (!next) return 0;  // its length is not there
    end = *next;
  }
  return std::min<std::uint64_t>(end, kMostHead);
}

Error wrong_frame(const FrameUnits& frame, const char* element) {
  return of_unit(UnitType::kFrame, frame.unit.offset, Errc::kOutOfRange, element);
}

}  // namespace

Result<Done> ArrivingFrames::push(std::span<const std::uint8_t> bytes) {
  if (failed_) return *failed_;
  std::vector<std::uint8_t>& to = lists_units() ? frames_[0].bytes : pending_;
  to.insert(to.end(), bytes.begin(), bytes.end());
  if (lists_units()) held_ += bytes.size();
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
  units_.reset();
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
      fail(moved_by(taken.error(), offset()));
      return *failed_;
    }
    more = *taken;
  }
  leave_taken();
  return Done{};
}

/// For good. Of a frame that was listed before its end a decode says so, too.
void ArrivingFrames::fail(const Error& error) {
  failed_ = error;
  if (!lists_units()) return;
  frames_[0].lost = error;
  infos_[0].lost = true;
  infos_[0].arriving = false;
}

void ArrivingFrames::leave_taken() {
  pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(at_));
  pending_offset_ += at_;
  at_ = 0;
}

/// @return whether there may be another. Errors count from rest()
Result<bool> ArrivingFrames::take_next() {
  if (units_) return take_units();
  if (rest().size() < needed_ && !finished_) return false;
  if (looking_) return find_intra();
  if (rest().empty()) return false;
  return next_ == 0 ? take_first() : take_frame();
}

Result<bool> ArrivingFrames::take_first() {
  const std::size_t known = std::min(rest().size(), kSignature.size());
  if (!std::equal(kSignature.begin(), kSignature.begin() + static_cast<std::ptrdiff_t>(known),
                  rest().begin()))
    return Error{Errc::kNotSlf, "signature"};
  if (known < kSignature.size() && finished_) return Error{Errc::kTruncated, "signature"};
  const auto sequence = end_of_unit(rest(), kSignature.size());
  const bool short_of_length = !sequence && sequence.error().code == Errc::kTruncated;
  needed_ = sequence ? *sequence + 1 : 0;  // what follows the sequence unit tells
  if ((short_of_length || rest().size() < needed_) && !finished_) return false;
  if (moves(rest())) return take_frame();
  units_.emplace();
  return true;
}

/// A light field that does not move is listed with its headers, and grows by units.
Result<bool> ArrivingFrames::take_units() {
  const auto taken = units_->take(lists_units() ? frames_[0].bytes : pending_, finished_);
  if (!lists_units() && (units_->has_headers() || (taken && finished_))) {
    infos_.resize(1);
    frames_.resize(1);
    held_ += pending_.size();
    frames_[0].bytes = std::exchange(pending_, {});
    next_ = 1;
  }
  if (lists_units()) {
    frames_[0].units.bytes = infos_[0].bytes = units_->bytes();
    infos_[0].arriving = !finished_ && !units_->complete();
  }
  if (!taken) return taken.error();
  return false;
}

/// Sequence and frame unit are still to come: they are looked at again when one more is whole.
bool ArrivingFrames::lacks_head(const Result<FrameUnits>& frame) {
  if (frame || frame.error().code != Errc::kTruncated || finished_ || rest().size() >= kMostHead)
    return false;
  needed_ = end_of_next_head(rest());
  return true;
}

Result<bool> ArrivingFrames::take_frame() {
  const auto frame = read_frame(rest(), 0);
  if (lacks_head(frame)) return false;
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
  needed_ = 0;
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
  if (lacks_head(frame)) return false;
  const FrameInfo& before = infos_[next_ - 1];
  if (!frame || frame->header.frame_number <= before.number ||
      frame->header.frame_time <= before.time) {
    ++at_;
    needed_ = 0;
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
