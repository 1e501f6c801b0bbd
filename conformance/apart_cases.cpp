// SPDX-License-Identifier: Apache-2.0
// Slices that are coded knowing their own points alone. Spec 7.3, 8.1, 8.8.3.
#include "bitstream/slice_headers.h"
#include "bitstream/unchecked_headers.h"
#include "codec/slice_digest.h"
#include "conformance/cases.h"
#include "conformance/edit_units.h"
#include "conformance/fields.h"

namespace slf::conformance {
namespace {

const VoxelBox kCorner{{0, 0, 0}, {9, 31, 31}};

/// Three slices, three groups, level ranges above and below the base.
Case apart(const std::string& id, const char* purpose) {
  Case c = case_of(id, purpose, {"7.3", "8.1", "8.8.3", "8.9"}, field(small_sphere(), 5, 6),
                   with_steps(6, 40));
  CodingParameters& p = c.parameters;
  p.group = {0, 1, 1, 2, 2, 2};
  p.geometry_level_ends = {1, 4, 5};
  p.coefficient_level_ends = {4, 5};
  p.base_levels = 2;
  p.max_slice_points = 370;
  p.slice_start = SliceStart::kApart;
  p.index = false;
  return c;
}

void add_five_bit_normals(LightField& f) {
  f.normals.bits = 5;
  for (std::size_t p = 0; p < f.num_points(); ++p)
    f.normals.octahedral.push_back(
        {static_cast<std::uint16_t>(p % 32), static_cast<std::uint16_t>(p / 5 % 32)});
}

void add_whole(std::vector<Case>& cases) {
  Case all = apart("apart", "slices that are added to a base");
  all.levels = {1, 3, 4};
  all.groups = {1, 2};
  all.regions = {kCorner};
  all.parameters.index = true;
  add_five_bit_normals(all.field);
  cases.push_back(all);
  Case independent = apart("apart-independent", "the independent coder");
  independent.parameters.coefficients = CoefficientCoder::kIndependent;
  cases.push_back(independent);
  Case layers = apart("apart-layers", "two layers; no prediction; cells of a weight of 1");
  layers.parameters.quality_layers = 2;
  layers.parameters.predict = false;
  layers.parameters.base_weight = 1;
  layers.layers = {1};
  layers.levels = {3};
  cases.push_back(layers);
  Case geometry = apart("apart-geometry", "slices without components, of unlike numbers of points");
  geometry.field = field(small_sphere(), 5, 0);
  geometry.parameters.step.clear();
  geometry.parameters.group.clear();
  geometry.parameters.max_slice_points = 205;
  cases.push_back(geometry);
  Case order = apart("apart-slice-by-slice", "slices one after the other, steps of 1");
  order.parameters.step = with_steps(6, 1).step;
  order.slice_by_slice = true;
  cases.push_back(order);
}

void add_cuts_apart(std::vector<Case>& cases) {
  const auto add = [&](const char* id, const char* purpose, int levels, int groups,
                       std::optional<VoxelBox> region) {
    Case c = apart(id, purpose);
    c.truncated.emplace();
    c.truncated->levels = levels;
    c.truncated->groups = groups;
    c.truncated->region = region;
    c.levels = {1, 3};
    c.groups = {1};
    cases.push_back(c);
  };
  add("apart-cut-levels", "a level range left out", 4, 0, {});
  add("apart-cut-groups", "a group left out", 0, 2, {});
  add("apart-cut-region", "slices left out, slice 0 among them", 0, 0,
      VoxelBox{{20, 20, 20}, {31, 31, 31}});
}

/// Units: sequence, slices, 2 of the base's geometry and 3 of its coefficients, then of three
/// slices 2 of geometry each and 6 of coefficients.
void add_apart_prefixes(std::vector<Case>& cases) {
  for (const std::size_t units : {6u, 9u, 12u, 15u, 20u}) {
    Case c = apart("apart-prefix-" + std::to_string(units), "slices apart, cut short");
    c.keep_units = units;
    c.levels = {2, 4};
    cases.push_back(c);
  }
}

/// Makes a digest of what each slice gives out, means of the base and all.
void digest_sums(UnitList& units, const LightField& sums, const SliceTable& table) {
  std::size_t begin = 0, slice = 0;
  const auto planes = static_cast<std::size_t>(sums.num_planes());
  for (EditableUnit& unit : units) {
    if (unit.type != UnitType::kDigest) continue;
    const std::size_t points = table.slices[slice++].points();
    const auto digest =
        slice_digest(std::span(sums.positions).subspan(begin, points),
                     std::span(sums.components).subspan(begin * planes, points * planes), {});
    std::copy(digest.begin(), digest.end(), unit.payload.end() - 32);
    begin += points;
  }
}

}  // namespace

std::vector<Case> apart_cases() {
  std::vector<Case> cases;
  add_whole(cases);
  add_cuts_apart(cases);
  add_apart_prefixes(cases);
  return cases;
}

std::vector<RefusedCase> refused_apart() {
  std::vector<RefusedCase> cases;
  const Case c = apart("", "");
  const Bytes stream = *pack(c.field, c.parameters);
  Case of_base = c;
  of_base.parameters.slice_start = SliceStart::kBase;
  const auto with_table = [&](const char* id, const char* purpose, const Bytes& of,
                              std::uint32_t start) {
    cases.push_back({id, purpose, {"7.3"}, edited(of, [&](auto& units) {
                       const auto set = *parse_sequence_parameter_set(units[0].payload);
                       Bytes& payload = first_of(units, UnitType::kSlices).payload;
                       SliceTable table = *parse_slice_table(payload, set);
                       table.slices_start = start;
                       payload = slice_table_as_is(table, set);
                     })});
  };
  with_table("slices-start", "slices that start from what is not known",
             *pack(of_base.field, of_base.parameters), 3);
  with_table("slices-start-other", "slices apart, said to start from the base", stream, 1);
  cases.push_back({"digest-of-sums",
                   "digests of components with the means of the base",
                   {"7.9"},
                   edited(stream, [&](auto& units) {
                     const auto set = *parse_sequence_parameter_set(units[0].payload);
                     const Bytes& payload = first_of(units, UnitType::kSlices).payload;
                     digest_sums(units, *decode(stream), *parse_slice_table(payload, set));
                   })});
  return cases;
}

}  // namespace slf::conformance
