// SPDX-License-Identifier: Apache-2.0
// Frames with less in them, and fewer of them. Spec 7.13, 8.9.
#include <algorithm>
#include <optional>
#include <utility>

#include "codec/decoder/decode_cost.h"
#include "codec/decoder/frame_chain.h"
#include "codec/encoder/assemble.h"
#include "codec/stream/select_units.h"
#include "slf/frames.h"

namespace slf {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Cuts the frames of a stream, which come in its order.
class FrameCutter {
 public:
  FrameCutter(std::span<const std::uint8_t> stream, const DecodeOptions& options)
      : stream_(stream), options_(options) {
    options_.max_bytes = 0;
  }

  /// @param alone  no frame that is kept is predicted from it
  Result<Bytes> cut(const FrameUnits& frame, bool alone) {
    return frame.header.predicted() ? cut_predicted(frame) : cut_intra(frame, alone);
  }

 private:
  Result<Bytes> cut_intra(const FrameUnits& frame, bool alone) {
    SLF_TRY(group_, open_stream(bytes_of(frame), options_.limits));
    SLF_TRY(Request request, request_of(group_->units, group_->scene, options_));
    // A predicted frame needs all levels of the one before: 8.12.7.
    const bool moves = group_->scene.stream.set.has_moved_points();
    if (request.kept_levels_only() && moves && !alone)
      return Error{Errc::kInvalidArgument, kEveryLevel};
    if (!(moves && alone)) request.kept = &predicted_from_;
    SLF_CHECK(check_limits(request, options_));
    asked_ = request;
    if (request.whole) return copy_of(frame);
    Bytes bytes(kSignature.begin(), kSignature.end());
    const auto all = all_slices(request);
    SLF_CHECK(of_what_was_read(append_sequence(bytes, cut_sequence(request, all, all))));
    SLF_CHECK(append_frame(frame, group_->units, request, bytes));
    return bytes;
  }

  Result<Bytes> cut_predicted(const FrameUnits& frame) {
    SLF_TRY(const OpenStream opened,
            open_predicted(stream_, frame, *group_, options_.limits.max_memory));
    SLF_TRY(Request request, request_of(opened.units, opened.scene, options_, &asked_));
    request.kept = &predicted_from_;
    SLF_CHECK(check_limits(request, options_));
    if (request.whole) return copy_of(frame);
    SLF_TRY(const Units own, predicted_units(stream_, frame, options_.limits.max_memory));
    Bytes bytes;
    SLF_CHECK(append_frame(frame, own, request, bytes));
    return bytes;
  }

  std::span<const std::uint8_t> bytes_of(const FrameUnits& frame) const {
    return stream_.subspan(static_cast<std::size_t>(frame.offset),
                           static_cast<std::size_t>(frame.bytes));
  }
  Bytes copy_of(const FrameUnits& frame) const {
    return {bytes_of(frame).begin(), bytes_of(frame).end()};
  }

  static std::vector<std::uint8_t> all_slices(const Request& request) {
    return std::vector<std::uint8_t>(request.stream.table.slices.size(), true);
  }

  /// The frame unit and those behind it. A frame that was whole has an end unit again.
  static Result<Done> append_frame(const FrameUnits& frame, const Units& own,
                                   const Request& request, Bytes& bytes) {
    SLF_TRY(const auto kept, select_units(own, request, all_slices(request)));
    Bytes rest;
    for (const UnitView& unit : kept.units) append_unit(rest, unit.type, unit.payload);
    const std::size_t before = frame.header.predicted() ? 1 : 2;
    if (own.complete) append_unit(rest, UnitType::kEnd, end_payload(before + kept.units.size()));
    FrameHeader header = frame.header;
    header.frame_bytes = static_cast<std::uint32_t>(rest.size());
    SLF_TRY(const auto payload, of_what_was_read(frame_payload(std::move(header), frame.vectors)));
    append_unit(bytes, UnitType::kFrame, payload);
    bytes.insert(bytes.end(), rest.begin(), rest.end());
    return Done{};
  }

  std::span<const std::uint8_t> stream_;
  DecodeOptions options_;
  // Stays empty. That frames keep what the next is predicted from makes them need all points.
  FrameState predicted_from_;
  std::optional<OpenStream> group_;  // the intra frame before
  GroupRequest asked_;               // of its group
};

}  // namespace

Result<Bytes> truncate_frames(std::span<const std::uint8_t> stream, std::size_t first,
                              std::size_t last, const DecodeOptions& options) {
  if (stream.size() > options.limits.max_stream_bytes) return Error{Errc::kLimitExceeded, "stream"};
  if (options.region) return Error{Errc::kInvalidArgument, "region"};
  SLF_TRY(const std::vector<FrameUnits> frames, split_frames(stream, options.limits.max_memory));
  if (first >= frames.size() || last < first) return Error{Errc::kInvalidArgument, "frame"};
  last = std::min(last, frames.size() - 1);
  while (frames[first].header.predicted()) --first;
  FrameCutter cutter(stream, options);
  Bytes kept;
  std::uint64_t before = 0;  // bytes of the frames that are kept, as they were
  for (std::size_t f = first; f <= last; ++f) {
    const bool alone = f == last || !frames[f + 1].header.predicted();
    SLF_TRY(const Bytes frame, cutter.cut(frames[f], alone));
    if (options.max_bytes > 0 && kept.size() + frame.size() > options.max_bytes) break;
    kept.insert(kept.end(), frame.begin(), frame.end());
    before += frames[f].bytes;
  }
  if (kept.empty()) return Error{Errc::kInvalidArgument, "max_bytes"};
  if (kept.size() <= before) return kept;
  // To say that frames are cut can take more bytes than were left out.
  const auto as_they_were = stream.subspan(static_cast<std::size_t>(frames[first].offset),
                                           static_cast<std::size_t>(before));
  return Bytes(as_they_were.begin(), as_they_were.end());
}

}  // namespace slf
