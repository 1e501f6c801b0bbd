#include "codec/frame_chain.h"

#include <utility>

#include "codec/decode_units.h"

namespace slf {
namespace {

Error of_frame(Errc code, const char* element) { return {code, element}; }

/// Offsets of an intra frame count from its own first byte.
Error moved(Error error, std::uint64_t offset) {
  error.bit_offset += 8 * offset;
  return error;
}

}  // namespace

Result<LightField> FrameChain::decode_intra(std::span<const std::uint8_t> stream,
                                            const FrameUnits& frame, const DecodeOptions& options,
                                            FrameState& kept) {
  const auto bytes = stream.subspan(static_cast<std::size_t>(frame.offset),
                                    static_cast<std::size_t>(frame.bytes));
  auto opened = open_stream(bytes, options.limits);
  if (!opened) return moved(opened.error(), frame.offset);
  group_ = *std::move(opened);
  const bool moves = frame.unit.bytes > 0;
  request_.emplace();
  auto field = decode_units(*group_, options, {nullptr, moves ? &kept : nullptr, nullptr, &*request_});
  if (!field) return moved(field.error(), frame.offset);
  return field;
}

Result<LightField> FrameChain::decode_predicted(std::span<const std::uint8_t> stream,
                                                const FrameUnits& frame,
                                                const DecodeOptions& options, FrameState& kept) {
  SequenceParameterSet set = group_->scene.stream.set;
  set.predicted = true;
  SLF_TRY(const Units own, predicted_units(stream, frame));
  Units units;  // behind those of the group_
  for (const Unit& unit : group_->units.units)
    if (unit.type == UnitType::kSequence || unit.type == UnitType::kTransform)
      units.units.push_back(unit);
  units.units.insert(units.units.end(), own.units.begin(), own.units.end());
  units.complete = own.complete;
  SLF_TRY(SceneUnits scene, collect_units(units, set));
  Motion motion = frame.header.motion;
  const int bits = scene.stream.grid_bits();
  if (state_.cells.empty()) return in_unit(frame.unit, of_frame(Errc::kOutOfRange, "frame_predicted_flag"));
  SLF_CHECK(in_unit(frame.unit, read_lattice(frame.vectors, state_.cells, bits, motion)));
  const FrameReference reference{state_, {state_.cells, motion, bits}};
  return decode_units({std::move(units), std::move(scene)}, options,
                      {&reference, &kept, &*request_, nullptr});
}

Result<LightField> FrameChain::decode(std::span<const std::uint8_t> stream, const FrameUnits& frame,
                                      const DecodeOptions& options) {
  FrameState kept;
  auto field = frame.header.predicted() ? decode_predicted(stream, frame, options, kept)
                                        : decode_intra(stream, frame, options, kept);
  if (field) state_ = std::move(kept);
  return field;
}

}  // namespace slf
