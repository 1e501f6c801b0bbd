// SPDX-License-Identifier: Apache-2.0
// Streams that no encoder writes, made of packed ones: units changed, added and left out.
#include "bitstream/bit_writer.h"
#include "bitstream/index.h"
#include "bitstream/unchecked_headers.h"
#include "codec/scene_units.h"
#include "conformance/cases.h"
#include "conformance/edit_units.h"
#include "conformance/fields.h"

namespace slf::conformance {
namespace {

/// Values beyond those that an encoder may give: steps are greater than the ones they were coded
/// with.
Bytes with_greater_steps(const LightField& field, const CodingParameters& parameters,
                         std::uint32_t factor) {
  return edited(packed_bare(field, parameters), [&](UnitList& units) {
    edit_sequence(units, [&](SequenceParameterSet& set) {
      for (PlaneRun& run : set.runs)
        for (std::uint32_t& step : run.sps_plane_step) step *= factor;
    });
  });
}

/// A cell of 64 points, which decodes to its clamp, beside a smaller one; of a base whose only cell
/// weighs 1.
LightField heavy_cell() {
  std::vector<Voxel> voxels = {{4, 7, 7}};
  for (std::int32_t i = 0; i < 63; ++i) voxels.push_back({i % 4, i / 4 % 4, i / 16});
  LightField f = field(sorted(std::move(voxels)), 4, 1);
  for (std::size_t p = 0; p < f.num_points(); ++p) {
    const bool apart = p + 1 == f.num_points();
    f.components[3 * p] = apart ? 9000000 : 8456000;
    f.components[3 * p + 1] = apart ? -9000000 : -8456000;
    f.components[3 * p + 2] = static_cast<std::int32_t>(p * 1000);
  }
  return f;
}

/// 64 points in one node of every level to 3, and a point apart that moves them beyond the clamp
/// of their cell row: level 1 is not corrected, level 2 has nodes of a single child alone.
Bytes with_lone_children() {
  std::vector<Voxel> voxels = {{8, 15, 15}};
  for (std::int32_t i = 0; i < 63; ++i) voxels.push_back({i % 4, i / 4 % 4, i / 16});
  LightField f = field(sorted(std::move(voxels)), 5, 1);
  for (std::size_t p = 0; p < f.num_points(); ++p)
    for (std::size_t c = 0; c < 3; ++c)
      f.components[3 * p + c] = (p + 1 == f.num_points() ? -5000000 : 10000000) >> c;
  CodingParameters p = with_steps(1, 1);
  p.base_levels = 1;
  p.base_weight = 1;
  p.predict = true;
  return edited(Bytes(with_greater_steps(f, p, 8)), [](UnitList& units) {
    const SequenceParameterSet set = *parse_sequence_parameter_set(units[0].payload);
    for (EditableUnit& unit : units)
      if (unit.type == UnitType::kCoefficients) set_modes(unit, set, {0, 1, 0, 0});
  });
}

void add_clamps(std::vector<Case>& cases) {
  CodingParameters p = with_steps(1, 1);
  p.base_levels = 1;
  p.base_weight = 1;
  Case cell = case_of_stream("cell-rows-clamped", "values of cell rows beyond 2^29", {"8.6.4"},
                             with_greater_steps(heavy_cell(), p, 8));
  cell.levels = {1, 2, 3};
  cases.push_back(cell);
  cases.push_back(case_of_stream("lone-children",
                                 "a value beyond 2^29 that no correction clamps, as its node has "
                                 "a single child",
                                 {"8.7.6"}, with_lone_children()));
  LightField greatest = field(scattered(40, 3, 12), 3, 1, 19000000);
  cases.push_back(case_of_stream("greatest-coefficients", "coefficients up to 2^27 - 1",
                                 {"8.7.4", "8.8.2"}, packed_bare(greatest, with_steps(1, 1))));
}

/// Types that may be skipped, at the borders of their ranges.
const UnitType kUnknown[] = {static_cast<UnitType>(64), static_cast<UnitType>(127),
                             static_cast<UnitType>(192), static_cast<UnitType>(224),
                             static_cast<UnitType>(255)};

/// A small scene of several slices.
LightField scene() {
  LightField f = field(sphere(3), 3, 2);
  f.normals.bits = 4;
  for (std::size_t p = 0; p < f.num_points(); ++p)
    f.normals.octahedral.push_back(
        {static_cast<std::uint16_t>(p * 7 % 16), static_cast<std::uint16_t>(p / 3 % 16)});
  return f;
}

CodingParameters scene_parameters() {
  CodingParameters p = with_steps(2, 30);
  p.group = {0, 1};
  p.base_levels = 1;
  p.max_slice_points = 40;
  p.geometry_level_ends = {1, 2, 3};
  p.coefficient_level_ends = {1, 2, 3};
  p.index = false;
  p.metadata = {{"a", ""}, {"b", "1"}};
  return p;
}

/// An index of the units behind `place`, put there.
void insert_index(UnitList& units, std::size_t place) {
  const SequenceParameterSet set = *parse_sequence_parameter_set(units[0].payload);
  Index index;
  for (std::size_t i = place; i < units.size(); ++i) {
    const EditableUnit& unit = units[i];
    Bytes payload = unit.payload;
    if (unit.type == UnitType::kEnd) {
      BitWriter end;
      end.ue(units.size());
      payload = end.take();
    }
    SliceUnitHeader ids;
    if (has_ids(unit.type)) ids = *read_ids({unit.type, payload, 0, 0}, set);
    index.entries.push_back({unit.type, unit_bytes(unit.type, payload.size()), ids});
  }
  const auto slices = parse_index(first_of(units, UnitType::kIndex).payload, set);
  index.boxes = slices->boxes;
  units.insert(units.begin() + static_cast<std::ptrdiff_t>(place),
               {UnitType::kIndex, index_as_is(index, set)});
}

void add_units(std::vector<Case>& cases) {
  cases.push_back(case_of_stream(
      "empty-codewords", "units with rows, whose coefficients are all zero", {"7.1", "8.7.1"},
      edited(packed_bare(scene(), with_steps(2, 1)), [](UnitList& units) {
        for (EditableUnit& unit : units)
          if (unit.type == UnitType::kCoefficients)
            unit.payload.resize(2);  // ue 0, ue 0, ue 0, u(2) x 3, alignment
        first_of(units, UnitType::kCoefficients).payload[1] &= 0x80;
      })));
  const Bytes whole = *pack(scene(), scene_parameters());
  cases.push_back(case_of_stream("units-of-other-types",
                                 "types to skip that the table does not name, everywhere",
                                 {"7.1", "7.1.1"}, edited(whole, [](UnitList& units) {
                                   for (std::size_t i = 1, k = 0; i < units.size(); i += 4, ++k)
                                     units.insert(units.begin() + static_cast<std::ptrdiff_t>(i),
                                                  {kUnknown[k % 5], Bytes(k * 3, 0xA5)});
                                 })));
  cases.push_back(case_of_stream("unit-of-16384-bytes", "a length of three bytes", {"7.1"},
                                 edited(whole, [](UnitList& units) {
                                   units.insert(units.end() - 1, {kUnknown[3], Bytes(16384, 0)});
                                 })));
  CodingParameters indexed = scene_parameters();
  indexed.index = true;
  cases.push_back(
      case_of_stream("index-twice", "an index again between slices; one of a unit of another type",
                     {"7.1", "7.7"}, edited(*pack(scene(), indexed), [](UnitList& units) {
                       units.insert(units.end() - 3, {kUnknown[1], Bytes(200, 1)});
                       insert_index(units, 9);
                       EditableUnit& first = first_of(units, UnitType::kIndex);
                       units.erase(units.begin() + (&first - units.data()));
                       insert_index(units, 1);
                     })));
  CodingParameters bare = scene_parameters();
  bare.metadata.clear();
  Case none = case_of_stream("no-slices", "a cut that left the sequence alone", {"7.1", "8.9.2"},
                             edited(*pack(scene(), bare), [](UnitList& units) {
                               edit_sequence(units, [](SequenceParameterSet& set) {
                                 set.sps_cut_flag = set.sps_cut_levels = 1;
                               });
                               units.erase(units.begin() + 1, units.end() - 1);
                             }));
  none.groups = {1};
  cases.push_back(none);
}

/// Beginnings of a scene, with normals: what is there, in levels and groups at once.
void add_beginnings(std::vector<Case>& cases) {
  UnitList all;
  edited(*pack(scene(), scene_parameters()), [&](UnitList& units) { all = units; });
  for (const std::size_t count : {4u, 6u, 8u, 10u, 12u, 14u, 16u, 18u, 20u}) {
    Case c = case_of_stream(
        "beginning-" + std::to_string(count),
        "the first " + std::to_string(count) + " units of a scene with normals",
        {"7.1", "8.9.1", "8.9.2", "8.9.3"},
        stream_of(UnitList(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count))));
    c.levels = {1, 2};
    c.groups = {1};
    for (int levels = 1; levels <= 2; ++levels) {
      c.decodes.emplace_back();
      c.decodes.back().levels = levels;
      c.decodes.back().groups = 1;
    }
    c.regions = {{{0, 0, 0}, {3, 3, 7}}};
    cases.push_back(c);
  }
}

/// The same without prediction: what is not known is not interpolated.
void add_unpredicted(std::vector<Case>& cases) {
  CodingParameters p = scene_parameters();
  p.predict = false;
  cases.push_back(case_of_stream(
      "beginning-unpredicted", "a beginning of a scene without prediction",
      {"7.1", "8.7.6", "8.9.1"},
      edited(*pack(scene(), p), [](UnitList& units) { units.resize(units.size() - 6); })));
}

void add_edited_geometry(std::vector<Case>& cases) {
  LightField f = scene();
  f.header.num_functions = 0;
  f.components.clear();
  CodingParameters p = scene_parameters();
  p.step.clear(), p.group.clear(), p.coefficient_level_ends.clear(), p.metadata.clear();
  Case c =
      case_of("normals-alone", "slices of points and normals, with digests, without components",
              {"7.2", "7.9", "8.10"}, f, p);
  c.levels = {2};
  cases.push_back(c);
}

}  // namespace

std::vector<Case> edited_cases() {
  std::vector<Case> cases;
  add_clamps(cases);
  add_units(cases);
  add_beginnings(cases);
  add_unpredicted(cases);
  add_edited_geometry(cases);
  return cases;
}

}  // namespace slf::conformance
