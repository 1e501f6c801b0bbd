// SPDX-License-Identifier: Apache-2.0
// Light fields that move: every kind of motion, of reference and of group. Spec 7.13, 8.12.
#include "codec/encoder/derive_transforms.h"
#include "codec/scene_units.h"
#include "codec/sequence.h"
#include "codec/transform_units.h"
#include "conformance/cases.h"
#include "conformance/edit_frames.h"
#include "conformance/fields.h"
#include "conformance/frame_fields.h"

namespace slf::conformance {
namespace {

void add_motions(std::vector<Case>& cases) {
  const auto add = [&](const char* id, const char* purpose, const LightField& second,
                       const Motion& motion, std::vector<std::string> clauses) {
    FrameWriter writer(frame_parameters(2));
    writer.add(still());
    writer.add(second, motion);
    cases.push_back(frame_case(id, purpose, writer, std::move(clauses)));
  };
  LightField louder = still();
  for (std::size_t i = 0; i < louder.components.size(); ++i)
    louder.components[i] += static_cast<std::int32_t>(i % 90);
  add("frames-identity", "two frames, nothing moves", louder, {}, {"7.13", "8.12.3", "8.12.4"});
  add("frames-affine", "an affine motion", frame_field(turned), turn(), {"7.13", "8.12.1"});
  Motion gentle;
  gentle.matrix = {{{-10, 1144, 37}, {-1144, -10, 611}, {-37, -611, -3}}};
  gentle.shift = {3, -5, 7};
  add("frames-gentle-turn", "a turn by a degree: products that are rounded", still(), gentle,
      {"8.12.1"});
  Motion far = turn();
  far.shift = {Motion::kMostShift, -Motion::kMostShift, 400};
  far.matrix[2] = {Motion::kMostEntry, -Motion::kMostEntry, Motion::kMostEntry};
  add("frames-out-of-the-grid", "a motion to where the reference has nothing", frame_field(turned),
      far, {"8.12.1", "8.12.2", "8.12.4"});
  add("frames-lattice", "vectors on a lattice, some without a cell of the reference around them",
      frame_field(bent), lattice_motion(3, {0, 1, 0}, {6, 3, 5}), {"7.13", "8.12.1"});
  Motion wide = lattice_motion(8, {0, 0, 0}, {2, 1, 1});
  wide.matrix = turn().matrix;
  add("frames-lattice-wider-than-the-grid", "all vectors are there", frame_field(bent), wide,
      {"7.13", "8.12.1"});
}

void add_groups_of_frames(std::vector<Case>& cases) {
  FrameWriter groups(frame_parameters(2));
  groups.add(still());
  groups.add(frame_field(turned), turn());
  groups.add(frame_field(bent));
  cases.push_back(frame_case("frames-groups", "three frames in two groups", groups, {"7.13"}));

  CodingParameters p = frame_parameters(2);
  p.geometry_level_ends = {2, 4, 5};
  p.coefficient_level_ends = {1, 4, 5};
  FrameWriter levels(p);
  levels.add(still());
  levels.add(frame_field(turned), turn());
  levels.add(frame_field([](const Voxel& v) { return turned(turned(v)); }), turn());
  Case c = frame_case("frames-levels", "units of several levels; states of each go on", levels,
                      {"8.12", "8.12.5"});
  c.levels = {1, 2, 3, 4};
  c.groups = {1};
  c.regions = {{{0, 0, 0}, {15, 20, 31}}};
  cases.push_back(c);

  LightField point = field({{9, 17, 30}}, kFrameBits, 2);
  FrameWriter vanish(frame_parameters(2));
  vanish.add(point);
  vanish.add(still(), {});
  vanish.add(point, {});
  cases.push_back(frame_case("frames-of-one-point", "points appear, and all but one vanish", vanish,
                             {"8.12.3", "8.12.4", "8.12.5"}));

  FrameWriter quiet(frame_parameters(3));
  LightField zeros = still(3);
  for (std::size_t i = 0; i < zeros.components.size(); ++i)
    if (i % 9 >= 3) zeros.components[i] = 0;
  quiet.add(zeros);
  quiet.add(still(3), {});
  cases.push_back(frame_case("frames-of-a-quiet-group", "a group of zeros, then not", quiet,
                             {"8.12.4", "8.12.5"}));
}

void add_kinds(std::vector<Case>& cases) {
  const auto with_codes = [](LightField f) {
    f.normals.bits = 4;
    for (std::size_t p = 0; p < f.num_points(); ++p)
      f.normals.octahedral.push_back(
          {static_cast<std::uint16_t>(p % 16), static_cast<std::uint16_t>(p / 5 % 16)});
    return f;
  };
  FrameWriter normals(frame_parameters(1));
  normals.add(with_codes(still(1)));
  normals.add(with_codes(frame_field(turned, 1)), turn());
  cases.push_back(
      frame_case("frames-normals", "normals, which are not predicted", normals, {"8.12"}));

  CodingParameters p;
  p.geometry_level_ends = {3, 5};
  FrameWriter geometry(p);
  geometry.add(still(0));
  geometry.add(frame_field(bent, 0), lattice_motion(3, {0, 0, 0}, {4, 4, 4}));
  Case c = frame_case("frames-geometry", "no components", geometry, {"8.12.3"});
  c.levels = {1, 4};  // the lattice needs cells of level 2 all the same
  cases.push_back(c);

  CodingParameters plain = frame_parameters(2);
  plain.predict = false;
  FrameWriter unpredicted(plain);
  unpredicted.add(still());
  unpredicted.add(frame_field(turned), turn());
  cases.push_back(frame_case("frames-without-modes", "components predicted at the root alone",
                             unpredicted, {"8.12.4"}));
}

/// Modes that the encoder did not choose: the values come out otherwise.
void add_modes(std::vector<Case>& cases) {
  CodingParameters p = frame_parameters(2);
  p.digest = false;
  FrameWriter writer(p);
  writer.add(still());
  writer.add(frame_field(turned), turn());
  const Bytes second = edited_frame(writer.frames()[1], [&](UnitList& units) {
    const Unit sequence = *read_unit(writer.frames()[0], kSignature.size());
    SequenceParameterSet set = *parse_sequence_parameter_set(sequence.payload);
    set.predicted = true;
    std::uint32_t first = 5;
    for (EditableUnit& unit : units)
      if (unit.type == UnitType::kCoefficients) {
        set_modes(unit, set, {first, 7, 6, first == 5 ? 7u : 4u, first == 5 ? 6u : 2u});
        first = 7;
      }
  });
  Case c = case_of_stream("frames-modes", "all modes of predicted levels", {"8.12.4"},
                          joined({writer.frames()[0], second}));
  c.frames = 2;
  c.levels = {3};
  cases.push_back(c);
}

/// The second frame cut off behind some units.
void add_partial(std::vector<Case>& cases) {
  CodingParameters p = frame_parameters(2);
  p.geometry_level_ends = p.coefficient_level_ends = {4, 5};
  FrameWriter writer(p);
  writer.add(still());
  writer.add(frame_field(turned), turn());
  for (const std::size_t keep : {1u, 3u, 5u}) {
    Bytes stream = writer.frames()[0];
    const Bytes& second = writer.frames()[1];
    std::size_t at = 0;
    for (std::size_t i = 0; i < keep; ++i)
      at += static_cast<std::size_t>(read_unit(second, at)->bytes);
    stream.insert(stream.end(), second.begin(), second.begin() + static_cast<std::ptrdiff_t>(at));
    Case c = case_of_stream("frames-prefix-" + std::to_string(keep),
                            "a predicted frame cut after " + std::to_string(keep) + " units",
                            {"7.13", "8.9.2"}, stream);
    c.frames = 2;
    cases.push_back(c);
  }
}

/// Two coded functions of four, by columns that stand in the first frame alone.
ForwardTransform columns_of_two(const PlaneGroups& groups) {
  ForwardTransform forward;
  PlaneTransform& t = forward.inverse;
  t.first_group = 1;
  t.num_groups = 1;
  t.functions = functions_of_groups(groups, 1, 1);
  t.rank = 2;
  t.lanes = 3;
  t.matrix = {1 << 13, 1 << 13, 1 << 13, 1 << 13, 1 << 14, -(1 << 12), 77, -(1 << 13)};
  forward.precision = {14, 14};
  return forward;
}

void add_transform(std::vector<Case>& cases) {
  CodingParameters p = frame_parameters(3);
  p.digest = false;
  FrameWriter writer(p);
  writer.add(still(3));
  writer.add(frame_field(turned, 3), turn());
  const Bytes first = edited_frame(writer.frames()[0], [](UnitList& units) {
    const SequenceParameterSet before = *parse_sequence_parameter_set(units[0].payload);
    edit_sequence(units, [](SequenceParameterSet& set) {
      set.sps_num_functions = 5;
      set.runs = {{0, 0, 0, 1, {30, 30, 30}}, {3, 1, 0, 1, {30, 30, 30}}};
      set.sps_transform_flag = 1;
      set.sps_num_transforms_minus1 = 0;
    });
    const SequenceParameterSet set = *parse_sequence_parameter_set(units[0].payload);
    const ForwardTransform transform = columns_of_two(plane_groups(set));
    for (EditableUnit& unit : units) {
      if (unit.type != UnitType::kCoefficients) continue;
      const auto header = read_part_unit({unit.type, unit.payload, 0, 0}, before)->header;
      const auto columns = columns_of_group(transform.inverse, plane_groups(set), header.group);
      set_matrix(unit, before, set, columns.empty() ? Bytes{} : write_columns(transform, columns));
    }
    units.insert(units.begin() + 2,
                 {UnitType::kTransform, *write_transform(transform, set.num_groups())});
  });
  Case c = case_of_stream("frames-transform", "matrices of the first frame are those of its group",
                          {"7.11", "7.13"}, joined({first, writer.frames()[1]}));
  c.frames = 2;
  c.groups = {1};
  cases.push_back(c);
}

}  // namespace

std::vector<Case> frame_cases() {
  std::vector<Case> cases;
  add_motions(cases);
  add_groups_of_frames(cases);
  add_kinds(cases);
  add_modes(cases);
  add_partial(cases);
  add_transform(cases);
  return cases;
}

}  // namespace slf::conformance
