// SPDX-License-Identifier: Apache-2.0
#include "codec/encoder/assemble.h"

#include <algorithm>

namespace slf {
namespace {

/// @errors kInvalidArgument: ids of a part that a reader would refuse
Result<Index, InputError> index_of(std::span<const UnitView> units,
                                   std::span<const std::uint8_t> end,
                                   const std::vector<CellBox>& boxes,
                                   const SequenceParameterSet& set) {
  Index index{{}, boxes};
  index.entries.reserve(units.size() + 1);
  for (const UnitView& unit : units) {
    index.entries.push_back({unit.type, unit_bytes(unit.type, unit.payload.size()), {}});
    if (!has_ids(unit.type)) continue;
    const auto ids = read_ids({unit.type, unit.payload}, set);
    if (!ids) return InputError{Errc::kInvalidArgument, ids.error().element};
    index.entries.back().ids = *ids;
  }
  index.entries.push_back({UnitType::kEnd, unit_bytes(UnitType::kEnd, end.size()), {}});
  return index;
}

/// The greatest payload.
std::uint64_t most_bytes(std::span<const UnitView> units, std::size_t others) {
  std::uint64_t most = others;
  for (const UnitView& unit : units) most = std::max<std::uint64_t>(most, unit.payload.size());
  return most;
}

/// Spec 9: the lowest level that promises something and admits these units; what was promised to
/// frames that come stays.
std::uint32_t level_of(const SequenceParameterSet& set, std::span<const UnitView> units,
                       std::uint64_t unit_bytes) {
  const UnitView* slices = nullptr;
  for (const UnitView& unit : units) {
    if (unit.type == UnitType::kFrame) return set.sps_level;
    if (unit.type == UnitType::kSlices) slices = &unit;
  }
  if (slices == nullptr) return 0;
  const auto table = parse_slice_table(slices->payload, set);
  if (!table) return 0;
  const std::uint64_t cells = set.sps_base_levels > 0 ? table->num_cells() : 0;
  for (std::uint32_t level = 1; level < kLevels.size(); ++level)
    if (kLevels[level].admits(table->num_points() + cells, set.sps_num_functions) &&
        unit_bytes <= kLevels[level].unit_bytes)
      return level;
  return 0;
}

}  // namespace

std::vector<std::uint8_t> end_payload(std::size_t units_before) {
  BitWriter end;
  end.ue(units_before);
  return end.take();
}

Result<Done, InputError> append_sequence(std::vector<std::uint8_t>& stream,
                                         const SequenceParameterSet& set) {
  SLF_TRY(const auto payload, write_sequence_parameter_set(set));
  append_unit(stream, UnitType::kSequence, payload, set.version_minor());
  return Done{};
}

Result<std::vector<std::uint8_t>, InputError> assemble(
    SequenceParameterSet set, std::span<const UnitView> units,
    const std::optional<std::vector<CellBox>>& boxes) {
  const auto end = end_payload(units.size() + (boxes ? 2 : 1));
  std::vector<std::uint8_t> index;
  if (boxes) {
    SLF_TRY(const Index entries, index_of(units, end, *boxes, set));
    SLF_TRY(index, write_index(entries, set));
  }
  set.sps_level = level_of(set, units, most_bytes(units, index.size()));
  std::vector<std::uint8_t> stream(kSignature.begin(), kSignature.end());
  SLF_CHECK(append_sequence(stream, set));
  if (boxes) append_unit(stream, UnitType::kIndex, index);
  for (const UnitView& unit : units) append_unit(stream, unit.type, unit.payload);
  append_unit(stream, UnitType::kEnd, end);
  return stream;
}

std::vector<UnitView> views_of(std::span<const CodedUnit> units) {
  std::vector<UnitView> views;
  views.reserve(units.size());
  for (const CodedUnit& unit : units) views.push_back({unit.type, unit.payload});
  return views;
}

Result<std::vector<std::uint8_t>, InputError> assemble(
    const SequenceParameterSet& set, std::span<const CodedUnit> units,
    const std::optional<std::vector<CellBox>>& boxes) {
  return assemble(set, std::span<const UnitView>(views_of(units)), boxes);
}

void append_slices(std::vector<std::vector<CodedUnit>> of_slice, std::vector<CodedUnit>& units) {
  std::size_t most = 0;
  for (const auto& slice : of_slice) most = std::max(most, slice.size());
  for (std::size_t place = 0; place < most; ++place)
    for (auto& slice : of_slice)
      if (place < slice.size()) units.push_back(std::move(slice[place]));
}

}  // namespace slf
