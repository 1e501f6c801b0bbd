// SPDX-License-Identifier: Apache-2.0
#include "codec/decoder/frame_chain.h"

#include <string_view>
#include <utility>

#include "bitstream/level.h"
#include "codec/decoder/decode_units.h"
#include "codec/decoder/frame_cost.h"
#include "codec/frame_vectors.h"

namespace slf {
namespace {

/// Offsets of an intra frame count from its own first byte, others from that of the bytes given.
Error moved(Error error, std::uint64_t offset) {
  if (has_place(error)) error.bit_offset += 8 * offset;
  return error;
}

/// The reference has no points, or not all of its geometry.
bool lacks_cells(const FrameState& reference, int bits) { return reference.cells.levels() != bits; }

/// Spec 9: points a second of its level. Seconds: since the reference.
bool in_time(const StreamHeader& stream, double seconds) {
  const std::uint64_t most = level_limits(stream.set.sps_level).points_a_second;
  return static_cast<double>(stream.table.num_points()) <= static_cast<double>(most) * seconds ||
         stream.set.sps_level == 0;
}

}  // namespace

Result<OpenStream> open_predicted(std::span<const std::uint8_t> stream, const FrameUnits& frame,
                                  const OpenStream& group, std::uint64_t max_memory) {
  SequenceParameterSet set = group.scene.stream.set;
  if (set.is_empty_frame())
    return of_unit(UnitType::kFrame, frame.unit.offset, Errc::kOutOfRange, "frame_predicted_flag");
  set.predicted = true;
  SLF_TRY(const Units own, predicted_units(stream, frame, max_memory));
  Units units;  // behind sequence and transforms of the group
  for (const Unit& unit : group.units.units)
    if (unit.type == UnitType::kSequence || unit.type == UnitType::kTransform)
      units.units.push_back(unit);
  units.units.insert(units.units.end(), own.units.begin(), own.units.end());
  units.complete = own.complete;
  SLF_TRY(SceneUnits scene, collect_units(units, set));
  scene.stream.bytes = frame.bytes;
  return OpenStream{std::move(units), std::move(scene)};
}

Result<LightField> FrameChain::decode_intra(std::span<const std::uint8_t> stream,
                                            const FrameUnits& frame, const DecodeOptions& options,
                                            FrameState& kept) {
  const auto bytes =
      stream.subspan(static_cast<std::size_t>(frame.offset), static_cast<std::size_t>(frame.bytes));
  SLF_TRY(OpenStream opened, open_stream(bytes, options.limits, options.max_bytes));
  if (!frame.moves()) return decode_units(opened, options);  // none follows
  group_ = std::move(opened);
  request_.emplace();
  FrameContext context;
  context.kept = &kept;
  context.asked = &*request_;
  return decode_units(*group_, options, context);
}

Result<LightField> FrameChain::decode_predicted(std::span<const std::uint8_t> stream,
                                                const FrameUnits& frame,
                                                const DecodeOptions& options, FrameState& kept) {
  SLF_TRY(const OpenStream opened,
          open_predicted(stream, frame, *group_, options.limits.max_memory));
  if (!in_time(opened.scene.stream, frame.header.frame_time - time_))
    return of_unit(UnitType::kFrame, frame.unit.offset, Errc::kOutOfRange, "frame_time");
  FrameHeader header = frame.header;
  const int bits = opened.scene.stream.grid_bits();
  if (lacks_cells(state_, bits))
    return of_unit(UnitType::kFrame, frame.unit.offset, Errc::kOutOfRange, "frame_predicted_flag");
  if (header.moves_points) SLF_CHECK(check_moves(frame, opened.scene.stream.set, options.limits));
  SLF_CHECK(in_unit(frame.unit, read_vectors(frame.vectors, state_.cells, bits, header)));
  MovedFrame moved;
  if (header.moves_points)
    moved = move_frame(state_, header.moves, header.motion, bits, 3 * request_->coded.size());
  LevelTerms terms;
  const FrameReference reference = header.moves_points
                                       ? FrameReference(state_, moved, bits, terms)
                                       : FrameReference(state_, header.motion, bits, terms);
  auto field = decode_units(opened, options, {&reference, &kept, &*request_, nullptr});
  error_is_of_group_ = !field && std::string_view(field.error().unit) == "sequence";
  return field;
}

/// Spec 7.13, 8.12.7: the group has such frames, all levels of its values, and memory is there.
Result<Done> FrameChain::check_moves(const FrameUnits& frame, const SequenceParameterSet& set,
                                     const DecodeLimits& limits) const {
  const auto wrong = [&](Errc code, const char* element) {
    return of_unit(UnitType::kFrame, frame.unit.offset, code, element);
  };
  const int bits = static_cast<int>(set.grid_bits());
  const std::size_t planes = 3 * request_->coded.size();
  if (!set.has_moved_points()) return wrong(Errc::kUnsupported, "frame_lattice_log2");
  const bool cut = set.sps_cut_flag != 0 && set.sps_cut_levels < set.grid_bits();
  const auto levels = static_cast<std::size_t>(bits) + 1;
  if (cut || (planes > 0 && state_.means.size() != levels))
    return wrong(Errc::kOutOfRange, "frame_predicted_flag");
  if (cost_of_moving(state_, bits, planes) > static_cast<double>(limits.max_memory))
    return Error{Errc::kLimitExceeded, "max_memory"};
  return Done{};
}

Result<LightField> FrameChain::decode(std::span<const std::uint8_t> stream, const FrameUnits& frame,
                                      const DecodeOptions& options, std::uint64_t begins) {
  FrameState kept;
  const bool predicted = frame.header.predicted();
  error_is_of_group_ = !predicted;
  if (!predicted) {
    state_ = {};  // its memory
    group_offset_ = begins + frame.offset;
  }
  auto field = predicted ? decode_predicted(stream, frame, options, kept)
                         : decode_intra(stream, frame, options, kept);
  state_ = field ? std::move(kept) : FrameState{};
  time_ = frame.header.frame_time;
  if (field) return field;
  return moved(field.error(), error_is_of_group_ ? group_offset_ : begins);
}

}  // namespace slf
