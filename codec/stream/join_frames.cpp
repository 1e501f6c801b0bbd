// SPDX-License-Identifier: Apache-2.0
// Streams of frames one after the other. Spec 7.13.
#include "slf/join_frames.h"

#include <algorithm>
#include <string>
#include <utility>

#include "codec/encoder/assemble.h"
#include "codec/scene_units.h"
#include "codec/split_frames.h"

namespace slf {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr double kIntervalOfOne = 1.0 / 30;  // seconds, behind a part of one frame

InputError of_part(const std::string& name, const std::string& what) {
  return {Errc::kInvalidInput, name + ": " + what};
}

/// A part whose frames are all there, up to their ends.
struct Part {
  const std::string* name = nullptr;
  std::span<const std::uint8_t> bytes;
  std::vector<FrameUnits> frames;

  std::uint32_t first() const { return frames.front().header.frame_number; }
  std::uint32_t last() const { return frames.back().header.frame_number; }
};

constexpr std::uint64_t kMemoryOfFrame = 3 * sizeof(FrameUnits);  // while a list grows

/// @param left  of the memory of lists; less by that of this one
Result<Part, InputError> open_part(const PartStream& given, std::uint64_t& left) {
  if (!moves(given.bytes)) return of_part(given.name, "no stream of frames");
  auto frames = split_frames(given.bytes, left);
  if (!frames && frames.error().code == Errc::kLimitExceeded)
    return InputError{Errc::kLimitExceeded,
                      given.name + ": its frames take more memory than the limit"};
  if (!frames) return of_part(given.name, to_string(frames.error()));
  std::uint64_t end = 0;
  for (const FrameUnits& frame : *frames) end = frame.end();
  if (end != given.bytes.size()) return of_part(given.name, "its last frame is cut short");
  left -= std::min(left, frames->size() * kMemoryOfFrame);
  return Part{&given.name, given.bytes, *std::move(frames)};
}

/// What all groups of a light field have in common, as it is coded: the gammas that cameras saw,
/// levels and features may differ.
Result<Bytes, InputError> common_header(const Part& part, const FrameUnits& frame) {
  const auto unit =
      read_unit(part.bytes, static_cast<std::size_t>(frame.offset) + kSignature.size());
  if (!unit) return of_part(*part.name, to_string(unit.error()));
  auto set = in_unit(*unit, parse_sequence_parameter_set(unit->payload));
  if (!set) return of_part(*part.name, to_string(set.error()));
  if (set->sps_cut_flag != 0) return of_part(*part.name, "units were left out of it");
  set->sps_level = set->features = 0;
  set->sps_gamma_min = set->sps_gamma_max = 0;
  set->sps_transform_flag = set->sps_num_transforms_minus1 = 0;
  return write_sequence_parameter_set(*set);
}

Result<Done, InputError> check_headers(std::span<const Part> parts) {
  const Part& first = parts.front();
  SLF_TRY(const Bytes expected, common_header(first, first.frames.front()));
  for (const Part& part : parts)
    for (const FrameUnits& frame : part.frames) {
      if (frame.header.predicted()) continue;
      SLF_TRY(const Bytes header, common_header(part, frame));
      if (header != expected)
        return of_part(*part.name, "grid, functions or steps are not those of " + *first.name);
    }
  return Done{};
}

/// Numbers go on from 0, part to part, and times. Whether frames are missing at the end no part
/// knows.
Result<Done, InputError> check_order(std::span<const Part> parts) {
  if (const std::uint32_t first = parts.front().first(); first > 0)
    return of_part(
        *parts.front().name,
        "its first frame is " + std::to_string(first) + ": " +
            (first == 1 ? "frame 0 is" : "frames 0 to " + std::to_string(first - 1) + " are") +
            " missing (--append joins what is there)");
  for (std::size_t p = 1; p < parts.size(); ++p) {
    const Part &before = parts[p - 1], &part = parts[p];
    if (part.first() <= before.last())
      return of_part(*part.name,
                     "frame " + std::to_string(part.first()) + " is in " + *before.name + " too");
    if (part.first() != before.last() + 1)
      return of_part(*part.name, "frame " + std::to_string(before.last() + 1) + " is missing");
    if (part.frames.front().header.frame_time <= before.frames.back().header.frame_time)
      return of_part(*part.name, "its first frame is not later than the last of " + *before.name);
  }
  return Done{};
}

/// Seconds from a frame to the next.
double interval(const Part& part) {
  const auto& frames = part.frames;
  return frames.size() < 2
             ? kIntervalOfOne
             : frames.back().header.frame_time - frames[frames.size() - 2].header.frame_time;
}

/// The frame with another number and time. Lengths and checksums of its other units stay.
Result<Done, InputError> append_moved(const Part& part, const FrameUnits& frame,
                                      std::uint32_t numbers, double seconds, Bytes& stream) {
  FrameHeader header = frame.header;
  header.frame_number += numbers;
  header.frame_time += seconds;
  SLF_TRY(const Bytes payload, frame_payload(std::move(header), frame.vectors));
  const auto copy = [&](std::uint64_t begin, std::uint64_t end) {
    stream.insert(stream.end(), part.bytes.begin() + static_cast<std::ptrdiff_t>(begin),
                  part.bytes.begin() + static_cast<std::ptrdiff_t>(end));
  };
  copy(frame.offset, frame.unit.offset);
  append_unit(stream, UnitType::kFrame, payload);
  copy(frame.unit.offset + frame.unit.bytes, frame.end());
  return Done{};
}

Result<Bytes, InputError> append_all(std::span<const Part> parts) {
  Bytes stream;
  std::int64_t next = parts.front().first();
  double time = parts.front().frames.front().header.frame_time;
  for (const Part& part : parts) {
    const double seconds = time - part.frames.front().header.frame_time;
    if (next + static_cast<std::int64_t>(part.frames.size()) > kMostFrames)
      return of_part(*part.name, "more than 2^31 frames");
    const std::uint32_t numbers = static_cast<std::uint32_t>(next) - part.first();
    for (const FrameUnits& frame : part.frames)
      SLF_CHECK(append_moved(part, frame, numbers, seconds, stream));
    next += static_cast<std::int64_t>(part.frames.size());
    time = part.frames.back().header.frame_time + seconds + interval(part);
  }
  return stream;
}

}  // namespace

bool is_of_frames(std::span<const std::uint8_t> stream) { return moves(stream); }

Result<Bytes, InputError> join_frames(std::span<const PartStream> given, JoinOrder order,
                                      const DecodeLimits& limits) {
  if (given.empty()) return InputError{Errc::kInvalidArgument, "parts: there are none"};
  std::vector<Part> parts;
  std::uint64_t left = limits.max_memory;
  for (const PartStream& part : given) {
    SLF_TRY(Part opened, open_part(part, left));
    parts.push_back(std::move(opened));
  }
  SLF_CHECK(check_headers(parts));
  if (order == JoinOrder::kAsGiven) return append_all(parts);
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return a.first() < b.first(); });
  SLF_CHECK(check_order(parts));
  Bytes stream;
  for (const Part& part : parts) stream.insert(stream.end(), part.bytes.begin(), part.bytes.end());
  return stream;
}

}  // namespace slf
