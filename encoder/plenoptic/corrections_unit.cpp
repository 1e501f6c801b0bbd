// The unit of corrections within a stream.
#include <algorithm>
#include <array>
#include <optional>

#include "bitstream/index.h"
#include "bitstream/parameter_sets.h"
#include "codec/encoder/assemble.h"
#include "encoder/plenoptic/corrections.h"

namespace slf {
namespace {

/// A type that the format leaves to applications, which whoever does not know it skips, and the
/// identifier of this application (spec 7.1.1, registry.md).
constexpr UnitType kCorrections = static_cast<UnitType>(kPrivateBit | kSkipBit);
constexpr std::array<std::uint8_t, 4> kIdentifier = {'S', 'L', 'F', 'p'};

bool has_corrections(const Unit& unit) {
  return unit.type == kCorrections && unit.payload.size() >= kIdentifier.size() &&
         std::equal(kIdentifier.begin(), kIdentifier.end(), unit.payload.begin());
}

}  // namespace

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
  std::vector<std::uint8_t> identified(kIdentifier.begin(), kIdentifier.end());
  identified.insert(identified.end(), payload.begin(), payload.end());
  kept.push_back({kCorrections, std::move(identified), {}});
  return assemble(set, kept, boxes);
}

Result<std::span<const std::uint8_t>> find_corrections(std::span<const std::uint8_t> stream) {
  SLF_TRY(const Units units, split_units(stream));
  const auto found = std::find_if(units.units.begin(), units.units.end(), has_corrections);
  if (found == units.units.end()) return std::span<const std::uint8_t>{};
  return found->payload.subspan(kIdentifier.size());
}

}  // namespace slf
