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

/// Appends a frame that begins a group.
Result<Done> append_annotated(const FrameUnits& frame, const OpenStream& opened,
                              const Annotations& annotations, Bytes& bytes) {
  SLF_TRY(const Annotated now, annotated(opened, annotations));
  Bytes rest;
  for (const UnitView& unit : now.units) append_unit(rest, unit.type, unit.payload);
  if (opened.units.complete) append_unit(rest, UnitType::kEnd, end_payload(2 + now.units.size()));
  FrameHeader header = frame.header;
  header.frame_bytes = static_cast<std::uint32_t>(rest.size());
  SLF_TRY(const auto payload, of_what_was_read(frame_payload(std::move(header), frame.vectors)));
  bytes.insert(bytes.end(), kSignature.begin(), kSignature.end());
  SLF_CHECK(of_what_was_read(append_sequence(bytes, now.set)));
  append_unit(bytes, UnitType::kFrame, payload);
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return Done{};
}

}  // namespace

Result<Bytes> annotate(std::span<const std::uint8_t> stream, const Annotations& annotations,
                       const DecodeLimits& limits) {
  const double metres = annotations.metres_per_unit.value_or(0);
  if (!(metres >= 0 && std::isfinite(metres)))
    return Error{Errc::kInvalidArgument, "metres_per_unit"};
  if (stream.size() > limits.max_stream_bytes) return Error{Errc::kLimitExceeded, "stream"};
  SLF_TRY(const std::vector<FrameUnits> frames, split_frames(stream, limits.max_memory));
  if (!frames.front().moves()) return annotate_still(stream, annotations, limits);
  Bytes bytes;
  bytes.reserve(stream.size());
  for (const FrameUnits& frame : frames) {
    const auto own = stream.subspan(static_cast<std::size_t>(frame.offset),
                                    static_cast<std::size_t>(frame.bytes));
    bool says = false;
    if (!frame.header.predicted()) {
      SLF_TRY(const OpenStream opened, open_stream(own, limits));
      SLF_TRY(const Metadata metadata, collect_metadata(opened.units));
      says = frame.offset == 0 || !metadata.empty() || annotations.metres_per_unit;
      if (says) SLF_CHECK(append_annotated(frame, opened, annotations, bytes));
    }
    if (!says) bytes.insert(bytes.end(), own.begin(), own.end());
  }
  return bytes;
}

}  // namespace slf
