// SPDX-License-Identifier: Apache-2.0
// Metadata and scale of a stream, written anew between units that stay. Spec 7.2, 7.8.
#include "slf/annotate.h"

#include <algorithm>
#include <cmath>

#include "codec/encoder/assemble.h"
#include "codec/frame_header.h"
#include "codec/scene_units.h"
#include "codec/split_frames.h"

namespace slf {
namespace {

using Bytes = std::vector<std::uint8_t>;

Metadata edited(const Metadata& before, const Annotations& annotations) {
  Metadata after;
  for (const auto& pair : before)
    if (std::none_of(annotations.metadata.begin(), annotations.metadata.end(),
                     [&](const auto& edit) { return edit.first == pair.first; }))
      after.push_back(pair);
  for (const auto& [key, value] : annotations.metadata)
    if (value) after.emplace_back(key, *value);
  return after;
}

/// The units of a stream, or of a frame that begins a group, with other metadata in its place, or
/// behind the others.
struct Annotated {
  SequenceParameterSet set;
  Bytes metadata;
  std::vector<UnitView> units;  ///< without those that are written anew
};

Result<Annotated> annotated(const OpenStream& opened, const Annotations& annotations) {
  SLF_TRY(const Metadata before, collect_metadata(opened.units));
  const Metadata after = edited(before, annotations);
  if (!is_metadata(after)) return Error{Errc::kInvalidArgument, "metadata"};
  Annotated out{opened.scene.stream.set, after.empty() ? Bytes() : write_metadata(after), {}};
  if (annotations.metres_per_unit) {
    out.set.sps_metres_flag = *annotations.metres_per_unit > 0;
    out.set.sps_metres_per_unit = *annotations.metres_per_unit;
  }
  bool placed = after.empty();
  for (const Unit& unit : opened.units.units) {
    if (unit.type == UnitType::kSequence || unit.type == UnitType::kIndex ||
        unit.type == UnitType::kFrame || unit.type == UnitType::kEnd ||
        unit.type == UnitType::kFiller)
      continue;
    if (unit.type != UnitType::kMetadata) {
      out.units.push_back({unit.type, unit.payload});
    } else if (!placed) {
      out.units.push_back({UnitType::kMetadata, out.metadata});
      placed = true;
    }
  }
  if (!placed) out.units.push_back({UnitType::kMetadata, out.metadata});
  return out;
}

Result<Bytes> annotate_still(std::span<const std::uint8_t> stream, const Annotations& annotations,
                             const DecodeLimits& limits) {
  SLF_TRY(const OpenStream opened, open_stream(stream, limits));
  SLF_TRY(const Annotated now, annotated(opened, annotations));
  std::optional<std::vector<CellBox>> boxes;
  if (opened.units.complete) {
    SLF_TRY(auto index, find_index(opened.units, opened.scene.stream.set));
    if (index) boxes = std::move(index->boxes);
  }
  SLF_TRY(Bytes bytes, of_what_was_read(assemble(now.set, now.units, boxes)));
  if (!opened.units.complete)
    bytes.resize(bytes.size() - static_cast<std::size_t>(unit_bytes(
                                    UnitType::kEnd, end_payload(now.units.size() + 1).size())));
  return bytes;
}

/// A frame that begins a group.
Result<Bytes> annotated_frame(const FrameUnits& frame, const OpenStream& opened,
                              const Annotations& annotations) {
  SLF_TRY(const Annotated now, annotated(opened, annotations));
  Bytes rest;
  for (const UnitView& unit : now.units) append_unit(rest, unit.type, unit.payload);
  if (opened.units.complete) append_unit(rest, UnitType::kEnd, end_payload(2 + now.units.size()));
  FrameHeader header = frame.header;
  header.frame_bytes = static_cast<std::uint32_t>(rest.size());
  SLF_TRY(const auto payload, of_what_was_read(frame_payload(std::move(header), frame.vectors)));
  Bytes bytes(kSignature.begin(), kSignature.end());
  SLF_CHECK(of_what_was_read(append_sequence(bytes, now.set)));
  append_unit(bytes, UnitType::kFrame, payload);
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}

/// The bytes of a vector stay where they are when it is moved.
void append_written(AnnotatedPieces& out, Bytes bytes) {
  out.written.push_back(std::move(bytes));
  out.pieces.emplace_back(out.written.back());
}

}  // namespace

std::size_t AnnotatedPieces::bytes() const {
  std::size_t sum = 0;
  for (const auto& piece : pieces) sum += piece.size();
  return sum;
}

Result<AnnotatedPieces> annotate_in_pieces(std::span<const std::uint8_t> stream,
                                           const Annotations& annotations,
                                           const DecodeLimits& limits) {
  const double metres = annotations.metres_per_unit.value_or(0);
  if (!(metres >= 0 && std::isfinite(metres)))
    return Error{Errc::kInvalidArgument, "metres_per_unit"};
  if (stream.size() > limits.max_stream_bytes) return Error{Errc::kLimitExceeded, "stream"};
  SLF_TRY(const std::vector<FrameUnits> frames, split_frames(stream, limits.max_memory));
  AnnotatedPieces out;
  if (!frames.front().moves()) {
    SLF_TRY(Bytes bytes, annotate_still(stream, annotations, limits));
    append_written(out, std::move(bytes));
    return out;
  }
  std::size_t kept = 0, end = 0;  // what stays and is no piece yet
  const auto append_kept = [&] {
    if (end > kept) out.pieces.push_back(stream.subspan(kept, end - kept));
  };
  for (const FrameUnits& frame : frames) {
    const auto begin = static_cast<std::size_t>(frame.offset),
               bytes = static_cast<std::size_t>(frame.bytes);
    if (!frame.header.predicted()) {
      SLF_TRY(const OpenStream opened, open_stream(stream.subspan(begin, bytes), limits));
      SLF_TRY(const Metadata metadata, collect_metadata(opened.units));
      if (begin == 0 || !metadata.empty() || annotations.metres_per_unit) {
        append_kept();
        SLF_TRY(Bytes written, annotated_frame(frame, opened, annotations));
        append_written(out, std::move(written));
        kept = begin + bytes;
      }
    }
    end = begin + bytes;
  }
  append_kept();
  return out;
}

Result<Bytes> annotate(std::span<const std::uint8_t> stream, const Annotations& annotations,
                       const DecodeLimits& limits) {
  SLF_TRY(AnnotatedPieces all, annotate_in_pieces(stream, annotations, limits));
  if (all.pieces.size() == 1 && all.written.size() == 1) return std::move(all.written.front());
  Bytes bytes;
  bytes.reserve(all.bytes());
  for (const auto& piece : all.pieces) bytes.insert(bytes.end(), piece.begin(), piece.end());
  return bytes;
}

}  // namespace slf
