// SPDX-License-Identifier: Apache-2.0
// What is wrong with slices, their units and the index of them.
#include <algorithm>
#include <functional>
#include <optional>

#include "bitstream/checked_syntax.h"
#include "bitstream/index.h"
#include "bitstream/unchecked_headers.h"
#include "codec/encoder/coded_unit.h"
#include "codec/scene_units.h"
#include "conformance/cases.h"
#include "conformance/edit_units.h"
#include "geometry/encoder/octree_encoder.h"
#include "geometry/morton.h"
#include "geometry/weight_classes.h"

namespace slf::conformance {
namespace {

/// The unit with other ids, nth of its type.
void edit_ids(UnitList& units, UnitType type, std::size_t nth,
              const std::function<void(SliceUnitHeader&)>& edit) {
  const auto set = *parse_sequence_parameter_set(units[0].payload);
  for (EditableUnit& unit : units) {
    if (unit.type != type || nth-- > 0) continue;
    PartUnit part = *read_part_unit({type, unit.payload, 0, 0}, set);
    const Bytes body(part.payload.begin(), part.payload.end());
    edit(part.header);
    unit.payload = header_as_is([&](auto& v) { slice_unit_header(v, part.header, type, set); });
    unit.payload.insert(unit.payload.end(), body.begin(), body.end());
    return;
  }
}

/// The first unit of a type that belongs to a slice.
EditableUnit& unit_of_slice(UnitList& units, UnitType type, std::uint32_t slice) {
  const auto set = *parse_sequence_parameter_set(units[0].payload);
  return *std::find_if(units.begin(), units.end(), [&](const EditableUnit& u) {
    return u.type == type && read_ids({type, u.payload, 0, 0}, set)->slice_id == slice;
  });
}

bool is_digest(const EditableUnit& unit) { return unit.type == UnitType::kDigest; }

/// What breaks one clause in the stream of edit_units.h.
void add(std::vector<RefusedCase>& cases, const char* id, const char* purpose, const char* clause,
         const UnitEdit& edit) {
  cases.push_back({id, purpose, {clause}, edited(edit)});
}

void add_slice_table(std::vector<RefusedCase>& cases) {
  const auto add_table = [&](const char* id, const char* purpose,
                             const std::function<void(SliceTable&)>& edit) {
    add(cases, id, purpose, "7.3", [&](auto& units) {
      const auto set = *parse_sequence_parameter_set(units[0].payload);
      auto& payload = first_of(units, UnitType::kSlices).payload;
      SliceTable table = *parse_slice_table(payload, set);
      edit(table);
      payload = slice_table_as_is(table, set);
    });
  };
  add_table("cells-more", "a slice of more cells than points",
            [](auto& t) { t.slices[0].slice_num_cells_minus1 = 3000; });
  add_table("cells-of-all", "more than 2^22 cells together", [](auto& t) {
    t.slices[0].slice_num_cells_minus1 = t.slices[0].slice_num_points_minus1 = kMaxCells - 2;
  });
  add_table("cells-one-more", "a cell that the base has not",
            [](auto& t) { ++t.slices[0].slice_num_cells_minus1; });
  add_table("cells-one-less", "a cell that no slice has",
            [](auto& t) { --t.slices[0].slice_num_cells_minus1; });
  add(cases, "slices-of-no-base", "two slices without a base", "7.3", [](auto& units) {
    edit_sequence(units, [](auto& set) { set.sps_base_levels = 0; });
    BitWriter out;
    for (const std::uint32_t number : {1u, 0u, 4u, 3u}) out.ue(number);
    first_of(units, UnitType::kSlices).payload = out.take();
  });
  add_table("points-one-more", "a point that the slice has not",
            [](auto& t) { ++t.slices[0].slice_num_points_minus1; });
}

void add_order(std::vector<RefusedCase>& cases) {
  add(cases, "slices-repeated", "the slices unit twice", "7.3", [](auto& units) {
    const EditableUnit table = first_of(units, UnitType::kSlices);
    units.insert(units.begin() + 2, table);
  });
  add(cases, "slices-late", "geometry before the slices unit", "7.1", [](auto& units) {
    auto& table = first_of(units, UnitType::kSlices);
    std::swap(table, *(&table + 1));
  });
  add(cases, "slices-missing", "a header and an end unit", "7.1",
      [](auto& units) { units.erase(units.begin() + 1, units.end() - 1); });
  add(cases, "slice-before-the-first", "a slice before the states it starts from", "7.1",
      [](auto& units) {
        auto& first = unit_of_slice(units, UnitType::kGeometry, 0);
        std::swap(first, unit_of_slice(units, UnitType::kGeometry, 1));
      });
  add(cases, "coefficients-before-the-first", "coefficients before the states they start from",
      "7.1", [](auto& units) {
        auto& first = unit_of_slice(units, UnitType::kCoefficients, 0);
        std::swap(first, unit_of_slice(units, UnitType::kCoefficients, 1));
      });
  add(cases, "base-late", "a unit of the base after one of a slice", "7.1", [](auto& units) {
    auto& slice = unit_of_slice(units, UnitType::kGeometry, 0);
    std::swap(slice, *(&slice - 1));
  });
  add(cases, "geometry-range-skipped", "the second of two geometry ranges first", "7.1",
      [](auto& units) {
        auto& base = first_of(units, UnitType::kGeometry);
        std::swap(base, *(&base + 1));
      });
  add(cases, "units-missing", "an end unit before the last units of the slices", "7.1",
      [](auto& units) {
        units.erase(std::remove_if(units.begin(), units.end(), is_digest), units.end());
        units.erase(units.end() - 3);
      });
  add(cases, "coefficients-out-of-order", "group 1 before group 0", "7.1", [](auto& units) {
    auto& first = first_of(units, UnitType::kCoefficients);
    std::swap(first, *(&first + 1));
  });
}

void add_payloads(std::vector<RefusedCase>& cases) {
  add(cases, "slices-too-many", "more slices than the unit has bits for", "7.3", [](auto& units) {
    BitWriter out;
    out.ue(kMaxSlices - 1);
    out.ue(0);
    first_of(units, UnitType::kSlices).payload = out.take();
  });
  add(cases, "slice-id", "a unit of a slice that there is not", "7.4", [](auto& units) {
    edit_ids(units, UnitType::kGeometry, 2, [](auto& ids) { ids.slice_id = 100; });
  });
  add(cases, "geometry-longer", "a codeword with bytes to spare", "8.3.1", [](auto& units) {
    auto& payload = first_of(units, UnitType::kGeometry).payload;
    payload.insert(payload.end(), 5, 0x55);  // four could be the decoder's register
  });
  add(cases, "geometry-shorter", "a codeword without its last bytes", "8.3.1", [](auto& units) {
    auto& payload = unit_of_slice(units, UnitType::kGeometry, 0).payload;
    payload.resize(payload.size() / 2);
  });
  add(cases, "coefficients-shorter", "coefficients without their last bytes", "8.3.1",
      [](auto& units) {
        auto& payload = first_of(units, UnitType::kCoefficients).payload;
        payload.resize(payload.size() / 2);
      });
  add(cases, "digest", "another digest", "7.9",
      [](auto& units) { first_of(units, UnitType::kDigest).payload.back() ^= 1; });
  add(cases, "metadata-garbage", "metadata that does not inflate", "7.8",
      [](auto& units) { first_of(units, UnitType::kMetadata).payload.back() ^= 1; });
}

/// The unit with the weight classes of base_stream, its cells and two levels coded with others;
/// none: occupancies alone.
void recode_classes(UnitList& units, std::optional<std::uint8_t> k) {
  const auto set = *parse_sequence_parameter_set(units[0].payload);
  DecodeOptions options;
  options.levels = static_cast<int>(set.sps_base_levels);
  std::vector<std::uint64_t> cells;
  const LightField base = *decode(base_stream(false), options);
  for (const Voxel& cell : base.positions) cells.push_back(morton(cell));
  const auto table = parse_slice_table(first_of(units, UnitType::kSlices).payload, set);
  OctreeEncoder octree(cells, options.levels, OccupancyStates(table->num_points()));
  octree.encode(static_cast<int>(set.geometry_end(0)));
  std::vector<std::uint8_t> classes;
  if (k) classes.assign(cells.size(), *k);
  EditableUnit& last = *(&first_of(units, UnitType::kGeometry) + 1);
  SliceUnitHeader header;
  header.range = 1;
  last.payload =
      part_unit(UnitType::kGeometry, header, octree.encode(options.levels, classes), set)->payload;
}

void add_weight_classes(std::vector<RefusedCase>& cases) {
  const auto add = [&](const char* id, const char* purpose, const UnitEdit& edit) {
    cases.push_back({id, purpose, {"8.4.5"}, edited(edit)});
  };
  add("weight-of-all", "cells that together weigh more than 2^24",
      [](auto& units) { recode_classes(units, kMostWeightClass); });
  add("weight-classes-missing", "a codeword that ends with the occupancies",
      [](auto& units) { recode_classes(units, {}); });
  const auto with_classes = [](auto& units) -> Bytes& {
    return (&first_of(units, UnitType::kGeometry) + 1)->payload;
  };
  add("weight-classes-shorter", "classes without their last bytes", [&](auto& units) {
    Bytes& payload = with_classes(units);
    payload.resize(payload.size() - 6);
  });
  add("weight-classes-longer", "bytes behind the classes", [&](auto& units) {
    Bytes& payload = with_classes(units);
    payload.insert(payload.end(), 5, 0x55);  // four could be the decoder's register
  });
}

/// The index changed; the units it is about stay.
/// most: so many bytes of it
Bytes with_index(const std::function<void(Index&)>& edit, std::size_t most = 1 << 20) {
  const Bytes whole = base_stream(true);
  const Units units = *split_units(whole);
  const auto set = *parse_sequence_parameter_set(units.units[0].payload);
  Index index = *parse_index(units.units[1].payload, set);
  edit(index);
  Bytes s(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(units.units[1].offset));
  Bytes payload = index_as_is(index, set);
  payload.resize(std::min(payload.size(), most));
  append_unit(s, UnitType::kIndex, payload);
  s.insert(s.end(), whole.begin() + static_cast<std::ptrdiff_t>(units.units[2].offset),
           whole.end());
  return s;
}

IndexEntry& entry_of(Index& index, UnitType type) {
  return *std::find_if(index.entries.begin(), index.entries.end(),
                       [type](const IndexEntry& entry) { return entry.type == type; });
}

void add_index(std::vector<RefusedCase>& cases) {
  const auto add = [&](const char* id, const char* purpose,
                       const std::function<void(Index&)>& edit) {
    cases.push_back({id, purpose, {"7.7"}, with_index(edit)});
  };
  add("index-wrong", "an index that names another length", [](auto& i) { ++i.entries[2].bytes; });
  add("index-type", "an index that names another type",
      [](auto& i) { i.entries[0].type = UnitType::kMetadata; });
  add("index-ids", "an index that names another slice",
      [](auto& i) { ++i.entries[i.entries.size() - 3].ids.slice_id; });
  add("index-more", "an index of a unit more than there are",
      [](auto& i) { i.entries.push_back(i.entries.back()); });
  add("index-level-range", "an index of a level range that there is not", [](auto& i) {
    SliceUnitHeader& ids = entry_of(i, UnitType::kGeometry).ids;
    ids.range = 3, ids.slice_id = 0;  // beyond the base's ranges units have a slice
  });
  add("index-group", "an index of a group that there is not",
      [](auto& i) { entry_of(i, UnitType::kCoefficients).ids.group = 2; });
  add("index-layer", "an index of a refinement that there is not", [](auto& i) {
    IndexEntry& entry = entry_of(i, UnitType::kCoefficients);
    entry.type = UnitType::kRefinement, entry.ids.layer = 4;
  });
  cases.push_back({"index-boxes-shorter",
                   "an index that ends long before its last box",
                   {"7.7"},
                   with_index([](auto& i) { i.boxes.resize(kMaxSlices); }, 100)});
  add("index-slices", "boxes of fewer slices than there are", [](auto& i) { i.boxes.pop_back(); });
  add("index-box", "a box that is not that of the cells", [](auto& i) { --i.boxes[0][3]; });
  add("index-box-range", "a box that ends before it begins",
      [](auto& i) { i.boxes[0][0] = 1, i.boxes[0][3] = 0; });
}

}  // namespace

std::vector<RefusedCase> refused_scenes() {
  std::vector<RefusedCase> cases;
  add_slice_table(cases);
  add_order(cases);
  add_payloads(cases);
  add_weight_classes(cases);
  add_index(cases);
  return cases;
}

}  // namespace slf::conformance
