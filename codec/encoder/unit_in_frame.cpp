// SPDX-License-Identifier: Apache-2.0
// A unit more in a frame that is coded. Spec 7.1.1, 7.13.
#include "codec/encoder/assemble.h"
#include "codec/encoder/pack_frame.h"
#include "codec/split_frames.h"

namespace slf {

Result<Units> units_alone(std::span<const std::uint8_t> stream) {
  if (begins_intra(stream)) return split_units(stream);
  SLF_TRY(const FrameUnits frame, read_frame(stream, 0));
  return predicted_units(stream, frame, ~std::uint64_t{0});
}

Result<std::vector<std::uint8_t>> with_unit(std::span<const std::uint8_t> bytes, UnitType type,
                                            std::span<const std::uint8_t> payload) {
  SLF_TRY(const FrameUnits frame, read_frame(bytes, 0));
  SLF_TRY(const Units units, units_alone(bytes));
  const Unit& end = units.units.back();
  const auto behind = bytes.subspan(static_cast<std::size_t>(frame.unit.offset + frame.unit.bytes));
  std::vector<std::uint8_t> rest(behind.begin(),
                                 behind.end() - static_cast<std::ptrdiff_t>(end.bytes));
  append_unit(rest, type, payload);
  append_unit(rest, UnitType::kEnd, end_payload(units.units.size()));
  FrameHeader header = frame.header;
  header.frame_bytes = static_cast<std::uint32_t>(rest.size());
  SLF_TRY(const auto unit, of_what_was_read(frame_payload(std::move(header), frame.vectors)));
  const auto before = bytes.first(static_cast<std::size_t>(frame.unit.offset));
  std::vector<std::uint8_t> all(before.begin(), before.end());
  append_unit(all, UnitType::kFrame, unit);
  all.insert(all.end(), rest.begin(), rest.end());
  return all;
}

}  // namespace slf
