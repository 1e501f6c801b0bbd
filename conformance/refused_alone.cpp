// SPDX-License-Identifier: Apache-2.0
// Streams that break one rule and no second one: a decoder without that check decodes them.
// one_rule.py shows it.
#include <algorithm>

#include "bitstream/crc32.h"
#include "bitstream/index.h"
#include "bitstream/unchecked_headers.h"
#include "conformance/cases.h"
#include "conformance/edit_units.h"
#include "conformance/fields.h"

namespace slf::conformance {
namespace {

/// A filler unit without payload, whose length takes a byte more than it needs.
Bytes with_longer_length() {
  Bytes stream = edited([](UnitList& units) {
    units.insert(units.end() - 1, {UnitType::kFiller, {}});
  });
  Bytes shortest, longer = {static_cast<std::uint8_t>(UnitType::kFiller), 0x80, 0};
  append_unit(shortest, UnitType::kFiller, {});
  const std::uint32_t crc = crc32(longer);
  for (int shift = 24; shift >= 0; shift -= 8)
    longer.push_back(static_cast<std::uint8_t>(crc >> shift));
  const auto at = std::search(stream.begin(), stream.end(), shortest.begin(), shortest.end());
  Bytes made(stream.begin(), at);
  made.insert(made.end(), longer.begin(), longer.end());
  made.insert(made.end(), at + static_cast<std::ptrdiff_t>(shortest.size()), stream.end());
  return made;
}

/// Sequence and slices unit alone, so that no other unit shows what is wrong.
Bytes slices_alone(const std::function<void(SliceTable&)>& edit) {
  UnitList kept;
  edited([&](UnitList& units) {
    edit_sequence(units, [](SequenceParameterSet& set) { set.sps_level = 0; });
    const auto set = *parse_sequence_parameter_set(units[0].payload);
    EditableUnit& unit = first_of(units, UnitType::kSlices);
    SliceTable table = *parse_slice_table(unit.payload, set);
    edit(table);
    unit.payload = slice_table_as_is(table, set);
    kept = {units[0], unit};
  });
  return stream_of(kept);
}

/// Three ranges of geometry, the second of no levels.
Bytes with_an_empty_range() {
  CodingParameters p;
  p.geometry_level_ends = {2, 4};
  return edited(packed_bare(field(lattice(3, 4, 5), 4, 0), p), [&](UnitList& units) {
    edit_sequence(units, [](SequenceParameterSet& set) {
      set.sps_num_geometry_ranges_minus1 = 2;
      set.sps_geometry_range_end = {2, 2};
    });
    EditableUnit& last = *std::find_if(units.rbegin(), units.rend(), [](const auto& unit) {
      return unit.type == UnitType::kGeometry;
    });
    last.payload[0] |= 0x20;  // level_range 1 becomes 2: ue(v) 010 and 011
    const auto at = std::find_if(units.begin(), units.end(),
                                 [](const auto& unit) { return unit.type == UnitType::kGeometry; });
    units.insert(at + 1, {UnitType::kGeometry, {0x50}});  // level_range 1, slice_id 0
  });
}

/// Ends with the index, which lists a refinement that has not come.
Bytes with_a_layer_that_there_is_not() {
  const Bytes whole = base_stream(true);
  const Units units = *split_units(whole);
  const auto set = *parse_sequence_parameter_set(units.units[0].payload);
  Index index = *parse_index(units.units[1].payload, set);
  IndexEntry& entry = *std::find_if(index.entries.begin(), index.entries.end(), [](const auto& e) {
    return e.type == UnitType::kCoefficients;
  });
  entry.type = UnitType::kRefinement;
  entry.ids.layer = 4;
  Bytes stream(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(units.units[1].offset));
  append_unit(stream, UnitType::kIndex, index_as_is(index, set));
  return stream;
}

}  // namespace

std::vector<RefusedCase> refused_alone() {
  std::vector<RefusedCase> cases;
  const auto add = [&](const char* id, const char* purpose, const char* clause, Bytes stream) {
    cases.push_back({id, purpose, {clause}, std::move(stream)});
  };
  add("alone-length-not-shortest", "a unit length with a needless byte, its checksum right", "7.1",
      with_longer_length());
  add("alone-range-ends", "a level range of no levels, with its unit", "7.2",
      with_an_empty_range());
  add("alone-cut-groups", "a cut to more groups than there are, before any unit of a group", "7.2",
      edited([](UnitList& units) {
        edit_sequence(units, [](SequenceParameterSet& set) {
          set.sps_cut_flag = 1;
          set.sps_cut_levels = set.grid_bits();
          set.sps_cut_groups = set.num_groups() + 1;
        });
        units = {units[0], first_of(units, UnitType::kSlices)};
      }));
  add("alone-cells-more", "a slice of more cells than points, whose geometry is missing", "7.3",
      slices_alone([](SliceTable& table) {
        table.slices[0].slice_num_points_minus1 = table.slices[0].slice_num_cells_minus1 - 1;
      }));
  add("alone-cells-of-all", "more than 2^22 cells together, none of which has come", "7.3",
      slices_alone([](SliceTable& table) {
        table.slices[0].slice_num_cells_minus1 = table.slices[0].slice_num_points_minus1 =
            kMaxCells - 2;
      }));
  add("alone-index-layer", "an index of a refinement that there is not, before that unit", "7.7",
      with_a_layer_that_there_is_not());
  return cases;
}

}  // namespace slf::conformance
