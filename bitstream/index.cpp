// SPDX-License-Identifier: Apache-2.0
#include "bitstream/index.h"

#include <algorithm>

#include "bitstream/checked_syntax.h"
#include "bitstream/unchecked_headers.h"

namespace slf {
namespace {

// Spec 7.7  index_entry( )
template <class V, class Entry>
void index_entry(V& v, Entry& entry, const SequenceParameterSet& set) {
  v.u(8, "index_unit_type", entry.type, Range{0, 255});
  v.ue("index_unit_bytes", entry.bytes, Range{6, 0xFFFFFFFE});
  if (has_ids(entry.type)) unit_ids(v, entry.ids, entry.type, set, kIndexIds);
}

// Spec 7.7  index_boxes( )
template <class V, class Boxes>
void index_boxes(V& v, Boxes& boxes, std::uint32_t base_levels) {
  std::uint32_t flag = !boxes.empty(), last = static_cast<std::uint32_t>(boxes.size()) - flag;
  v.u(1, "index_boxes_flag", flag, Range{0, base_levels > 0});
  if (!flag) return;
  v.ue("index_num_slices_minus1", last, Range{0, kMaxSlices - 1});
  v.resize("index_num_slices_minus1", boxes, std::uint64_t{last} + 1);
  const int bits = static_cast<int>(base_levels);
  for (auto& box : boxes)
    for (std::size_t i = 0; i < 6; ++i)
      v.u(bits, "index_box", box[i],
          Range{i < 3 ? 0 : std::int64_t{box[i - 3]}, (std::int64_t{1} << bits) - 1});
}

/// An index that is there.
template <class V>
void whole_index(V& v, const Index& index, const SequenceParameterSet& set) {
  v.ue("index_num_units", index.entries.size(), Range{0, 0xFFFFFFFE});
  for (const IndexEntry& entry : index.entries) index_entry(v, entry, set);
  index_boxes(v, index.boxes, set.sps_base_levels);
}

Result<Done> check_entry(const IndexEntry& entry, const Unit& unit, const SequenceParameterSet& set,
                         const Unit& index) {
  if (unit.type != entry.type) return in_unit(index, Error{Errc::kOutOfRange, "index_unit_type"});
  if (unit.bytes != entry.bytes)
    return in_unit(index, Error{Errc::kOutOfRange, "index_unit_bytes"});
  if (!has_ids(unit.type)) return Done{};
  SLF_TRY(const SliceUnitHeader ids, read_ids(unit, set));
  if (!same_ids(ids, entry.ids)) return in_unit(index, Error{Errc::kOutOfRange, "index_unit_ids"});
  return Done{};
}

}  // namespace

bool same_ids(const SliceUnitHeader& a, const SliceUnitHeader& b) {
  return a.slice_id == b.slice_id && a.range == b.range && a.group == b.group && a.layer == b.layer;
}

Result<SliceUnitHeader> read_ids(const Unit& unit, const SequenceParameterSet& set) {
  BitReader in(unit.payload);
  ParseSyntax parse{in};
  SliceUnitHeader ids;
  unit_ids(parse, ids, unit.type, set);
  if (!in.ok()) return in_unit(unit, in.error());
  return ids;
}

Result<Index> parse_index(std::span<const std::uint8_t> payload, const SequenceParameterSet& set,
                          SyntaxLog* log) {
  BitReader in(payload);
  ParseSyntax parse{in, log};
  std::uint32_t count = 0;
  Index index;
  parse.ue("index_num_units", count, Range{0, 0xFFFFFFFE});
  parse.require(count <= in.bits_left() / kLeastIndexEntryBits, Errc::kTruncated,
                "index_num_units");
  parse.resize("index_num_units", index.entries, count);
  for (IndexEntry& entry : index.entries) index_entry(parse, entry, set);
  index_boxes(parse, index.boxes, set.sps_base_levels);
  in.trailing_bits("index_trailing_bits");
  if (!in.ok()) return in.error();
  return index;
}

Result<Index> read_index(const Unit& unit, const SequenceParameterSet& set) {
  return in_unit(unit, parse_index(unit.payload, set));
}

Result<std::vector<std::uint8_t>, InputError> write_index(const Index& index,
                                                          const SequenceParameterSet& set) {
  return checked_header([&](auto& v) { whole_index(v, index, set); });
}

std::vector<std::uint8_t> index_as_is(const Index& index, const SequenceParameterSet& set) {
  return header_as_is([&](auto& v) { whole_index(v, index, set); });
}

Result<std::optional<Index>> find_index(const Units& units, const SequenceParameterSet& set) {
  const Unit* unit = units.first(UnitType::kIndex);
  if (unit == nullptr) return std::optional<Index>();
  SLF_TRY(Index index, read_index(*unit, set));
  return std::optional<Index>(std::move(index));
}

Result<Done> check_index(const Units& units, const SequenceParameterSet& set, std::size_t slices) {
  for (std::size_t at = 0; at < units.units.size(); ++at) {
    const Unit& unit = units.units[at];
    if (unit.type != UnitType::kIndex) continue;
    SLF_TRY(const Index index, read_index(unit, set));
    const std::size_t present = units.units.size() - at - 1;
    if (present > index.entries.size() || (units.complete && present < index.entries.size()))
      return in_unit(unit, Error{Errc::kOutOfRange, "index_num_units"});
    for (std::size_t i = 0; i < present; ++i)
      SLF_CHECK(check_entry(index.entries[i], units.units[at + 1 + i], set, unit));
    if (slices > 0 && !index.boxes.empty() && index.boxes.size() != slices)
      return in_unit(unit, Error{Errc::kOutOfRange, "index_num_slices_minus1"});
  }
  return Done{};
}

}  // namespace slf
