// SPDX-License-Identifier: Apache-2.0
#include "codec/split_frames.h"

#include <algorithm>

namespace slf {
namespace {

/// What no frame begins with, cut short or not.
Result<Done> check_first_byte(std::span<const std::uint8_t> rest, std::size_t at) {
  if (rest.empty()) return Error{Errc::kTruncated, "signature", 8 * at};
  const auto type = static_cast<UnitType>(rest[0]);
  if (rest[0] == kSignature[0]) {
    const auto end = std::min(rest.size(), kSignature.size());
    const bool good = std::equal(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(end),
                                 kSignature.begin());
    if (!good) return Error{Errc::kOutOfRange, "signature", 8 * at};
    if (end < kSignature.size()) return Error{Errc::kTruncated, "signature", 8 * at};
  } else if (type != UnitType::kFrame) {
    return of_unit(type, at, Errc::kOutOfRange, "unit_type");
  }
  return Done{};
}

Error wrong(const Unit& unit, const char* element) {
  return of_unit(unit.type, unit.offset, Errc::kOutOfRange, element);
}

}  // namespace

constexpr std::uint64_t kMemoryOfFrame = 3 * sizeof(FrameUnits);  // while the list grows

bool begins_intra(std::span<const std::uint8_t> rest) {
  return rest.size() >= kSignature.size() &&
         std::equal(kSignature.begin(), kSignature.end(), rest.begin());
}

bool moves(std::span<const std::uint8_t> stream) {
  if (!begins_intra(stream)) return false;
  const auto sequence = read_unit(stream, kSignature.size());
  if (!sequence) return false;
  const std::uint64_t next = sequence->offset + sequence->bytes;
  return next < stream.size() &&
         stream[static_cast<std::size_t>(next)] == static_cast<std::uint8_t>(UnitType::kFrame);
}

Result<FrameUnits> read_frame(std::span<const std::uint8_t> stream, std::size_t at) {
  FrameUnits frame;
  frame.offset = at;
  SLF_CHECK(check_first_byte(stream.subspan(at), at));
  const bool intra = begins_intra(stream.subspan(at));
  if (intra) {
    SLF_TRY(const Unit sequence, read_unit(stream, at + kSignature.size()));
    if (sequence.type != UnitType::kSequence) return wrong(sequence, "unit_type");
    at = static_cast<std::size_t>(sequence.offset + sequence.bytes);
  }
  SLF_TRY(frame.unit, read_unit(stream, at));
  if (frame.unit.type != UnitType::kFrame) return wrong(frame.unit, "unit_type");
  SLF_TRY(frame.header, in_unit(frame.unit, parse_frame_header(frame.unit.payload, frame.vectors)));
  if (frame.header.predicted() == intra) return wrong(frame.unit, "frame_predicted_flag");
  frame.bytes = std::min<std::uint64_t>(frame.end(), stream.size()) - frame.offset;
  return frame;
}

Result<std::vector<FrameUnits>> split_frames(std::span<const std::uint8_t> stream,
                                             std::uint64_t max_memory) {
  std::vector<FrameUnits> frames;
  if (!moves(stream)) {
    SLF_CHECK(split_units(stream, 0, max_memory));
    frames.emplace_back();
    frames.back().bytes = stream.size();
    return frames;
  }
  for (std::uint64_t at = 0; at < stream.size();) {
    auto frame = read_frame(stream, static_cast<std::size_t>(at));
    if (!frame && frame.error().code == Errc::kTruncated && !frames.empty()) break;  // cut there
    if (!frame) return frame.error();
    if (!frames.empty()) {
      const FrameHeader& before = frames.back().header;
      if (frame->header.frame_number != before.frame_number + 1)
        return wrong(frame->unit, "frame_number");
      if (frame->header.frame_time <= before.frame_time) return wrong(frame->unit, "frame_time");
    }
    if (frames.size() >= max_memory / kMemoryOfFrame)
      return Error{Errc::kLimitExceeded, "max_memory"};
    at += frame->bytes;
    frames.push_back(*std::move(frame));
  }
  return frames;
}

Result<FrameUnits> first_frame(std::span<const std::uint8_t> stream) {
  FrameUnits all;
  all.bytes = stream.size();
  if (!moves(stream)) return all;
  auto frame = read_frame(stream, 0);
  if (!frame && frame.error().code == Errc::kTruncated) return all;
  return frame;
}

Result<Done> check_frame_bytes(const FrameUnits& frame, const Units& units) {
  if (frame.moves() && units.complete && frame.end() != frame.offset + frame.bytes)
    return wrong(frame.unit, "frame_bytes");
  return Done{};
}

Result<Units> predicted_units(std::span<const std::uint8_t> stream, const FrameUnits& frame,
                              std::uint64_t max_memory) {
  Units result;
  const std::uint64_t end = frame.offset + frame.bytes;
  const auto bytes = stream.first(static_cast<std::size_t>(end));
  for (std::uint64_t at = frame.offset; at < end;) {
    if (result.complete) return Error{Errc::kOutOfRange, "end_of_stream", 8 * at};
    auto unit = read_unit(bytes, static_cast<std::size_t>(at));
    if (!unit) return unit.error();
    const bool first = at == frame.offset;
    if ((unit->type == UnitType::kFrame) != first || unit->type == UnitType::kSequence ||
        unit->type == UnitType::kTransform || unit->type == UnitType::kIndex ||
        unit->type == UnitType::kMetadata)
      return wrong(*unit, "unit_type");
    if (unit->type == UnitType::kEnd) {
      SLF_CHECK(in_unit(*unit, check_end(unit->payload, result.units.size())));
      result.complete = true;
    }
    if (result.units.size() >= max_memory / kMemoryOfUnit)
      return Error{Errc::kLimitExceeded, "max_memory"};
    result.units.push_back(*unit);
    at += unit->bytes;
  }
  SLF_CHECK(check_frame_bytes(frame, result));
  return result;
}

}  // namespace slf
