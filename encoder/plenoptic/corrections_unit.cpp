// SPDX-License-Identifier: Apache-2.0
// The unit of corrections within a stream.
#include <optional>

#include "bitstream/index.h"
#include "bitstream/parameter_sets.h"
#include "codec/encoder/assemble.h"
#include "codec/encoder/pack_frame.h"
#include "encoder/plenoptic/corrections.h"

namespace slf {

Result<std::vector<std::uint8_t>> with_corrections(std::span<const std::uint8_t> stream,
                                                   std::span<const std::uint8_t> payload) {
  SLF_TRY(const Units units, split_units(stream));
  const Unit* sequence = units.first(UnitType::kSequence);
  if (sequence == nullptr) return Error{Errc::kOutOfRange, "unit_type"};
  SLF_TRY(const auto set, in_unit(*sequence, parse_sequence_parameter_set(sequence->payload)));
  SLF_TRY(const auto index, find_index(units, set));
  std::optional<std::vector<CellBox>> boxes;
  if (index) boxes = index->boxes;
  std::vector<CodedUnit> kept;
  for (const Unit& unit : units.units) {
    if (unit.type == UnitType::kSequence || unit.type == UnitType::kIndex ||
        unit.type == UnitType::kEnd)
      continue;
    SliceUnitHeader ids;
    if (has_ids(unit.type)) {
      SLF_TRY(ids, read_ids(unit, set));
    }
    kept.push_back({unit.type, {unit.payload.begin(), unit.payload.end()}, std::move(ids)});
  }
  kept.push_back({kApplicationUnit, with_identifier(kPlenopticCorrections, payload), {}});
  return of_what_was_read(assemble(set, kept, boxes));
}

std::vector<std::uint8_t> corrections_of_frame(std::span<const std::uint8_t> payload) {
  return with_identifier(kPlenopticCorrections, payload);
}

Result<std::span<const std::uint8_t>> find_corrections(std::span<const std::uint8_t> stream) {
  SLF_TRY(const Units units, units_alone(stream));
  for (const Unit& unit : units.units)
    if (is_of_application(unit, kPlenopticCorrections)) return application_payload(unit);
  return std::span<const std::uint8_t>{};
}

}  // namespace slf
