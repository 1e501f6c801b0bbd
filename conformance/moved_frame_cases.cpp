// SPDX-License-Identifier: Apache-2.0
// Points of the reference that move one by one: alone and over a lattice, together, away, and out
// of the grid. Spec 8.12.7.
#include "codec/frame_vectors.h"
#include "conformance/fields.h"
#include "conformance/frame_fields.h"

namespace slf::conformance {
namespace {

using MovesOf = std::function<PointMove(std::size_t point)>;

FrameWriter moved_writer(const CodingParameters& parameters) {
  return FrameWriter(parameters, 0, kReferenceContexts | kMovedPoints);
}

/// Where a motion leads back to.
Motion onwards() {
  Motion motion = turn();
  for (auto& row : motion.matrix)
    for (auto& entry : row) entry = -entry;
  for (auto& part : motion.shift) part = -part;
  return motion;
}

/// Some stay, some move by a little, and a few by much.
PointMove some_move(std::size_t point) {
  const auto p = static_cast<std::int32_t>(point);
  if (p % 3 != 0) return {};
  if (p % 29 == 0) return {p % 40 - 20, 700 - p, 0};
  return {p % 5 - 2, p / 3 % 3 - 1, p / 7 % 2};
}

PointMove none(std::size_t) { return {}; }

void add_levels(std::vector<Case>& cases) {
  CodingParameters p = frame_parameters(2);
  p.geometry_level_ends = {2, 4, 5};
  p.coefficient_level_ends = {1, 4, 5};
  FrameWriter levels = moved_writer(p);
  levels.add(still());
  levels.add_moved(frame_field(turned), onwards(), some_move);
  levels.add(still(), turn());
  levels.add_moved(frame_field(turned), onwards(), none);
  Case c = frame_case("frames-moved-levels", "all levels are needed, whatever is asked for", levels,
                      {"8.12.7", "8.12"});
  c.levels = {1, 2, 3, 4};
  c.groups = {1};
  c.regions = {{{0, 0, 0}, {15, 20, 31}}};
  cases.push_back(c);
  Bytes cut = levels.frames()[0];
  const Bytes& second = levels.frames()[1];
  std::size_t at = 0;
  for (int i = 0; i < 4; ++i) at += static_cast<std::size_t>(read_unit(second, at)->bytes);
  cut.insert(cut.end(), second.begin(), second.begin() + static_cast<std::ptrdiff_t>(at));
  Case prefix = case_of_stream("frames-moved-prefix", "a frame cut behind its second octree unit",
                               {"8.12.7", "8.9.2"}, cut);
  prefix.frames = 2;
  cases.push_back(prefix);
  DecodeOptions fewer;
  fewer.groups = 1;
  Case group = case_of_stream("frames-moved-cut", "a group was left out", {"8.12.7", "8.9"},
                              *truncate_frames(levels.stream(), 0, 3, fewer));
  group.frames = 4;
  cases.push_back(group);
}

/// Splats that turn: attributes in predicted frames, two groups, one a transform.
Case attributes_case(bool moved) {
  LightFieldHeader header;
  header.basis = {BasisId::kHarmonics, 2, 0, 0, 1};
  header.attributes = {{AttributeId::kOpacity, 1}, {AttributeId::kShape, 2}};
  header.num_functions = 7;
  header.colour = ColourTransform::kOpponent;
  header.shift.assign(7, 2);
  header.grid = {{-1, 0.5, 2}, 0.25, kFrameBits};
  const auto of = [&](const std::function<Voxel(const Voxel&)>& to) {
    LightField made = frame_field(to, 7);
    made.header = header;
    return made;
  };
  CodingParameters p = with_steps(7, 12);
  p.group = {0, 1, 1, 1, 2, 2, 2};
  FrameWriter writer = moved ? moved_writer(p) : FrameWriter(p, 0, kReferenceContexts);
  writer.add(of([](const Voxel& v) { return v; }));
  for (int f = 0; f < 2; ++f)
    if (moved)
      writer.add_moved(of(turned), f == 0 ? onwards() : Motion{}, some_move);
    else
      writer.add(of(turned), f == 0 ? turn() : Motion{});
  Case c = frame_case(moved ? "frames-moved-attributes" : "frames-attributes",
                      moved ? "splats that move one by one" : "attributes in predicted frames",
                      writer, {"6.8", moved ? "8.12.7" : "8.12.4"});
  c.groups = {1, 2};
  return c;
}

}  // namespace

std::vector<Case> moved_frame_cases() {
  std::vector<Case> cases;
  const auto add = [&](const char* id, const char* purpose, const LightField& second,
                       const Motion& motion, const MovesOf& of) {
    FrameWriter writer = moved_writer(frame_parameters(2));
    writer.add(still());
    writer.add_moved(second, motion, of);
    writer.add_moved(still(), {}, of);
    cases.push_back(frame_case(id, purpose, writer, {"8.12.7", "7.13"}));
  };
  add("frames-moved", "points move over an affine motion", frame_field(turned), onwards(),
      some_move);
  add("frames-moved-nowhere", "points move, each to where it is", still(), {}, none);
  add("frames-moved-lattice", "points move over a lattice", frame_field(bent),
      lattice_motion(3, {0, 1, 0}, {6, 3, 5}), some_move);
  add("frames-moved-widest-lattice", "points move over the widest lattice", frame_field(bent),
      lattice_motion(8, {0, 0, 0}, {2, 1, 1}), some_move);
  add("frames-moved-together", "many points end in one voxel, beyond the grid at its border",
      still(), {}, [](std::size_t p) {
        constexpr std::int32_t kMost = 1 << 21;
        return p % 4 == 0 ? PointMove{kMost, -kMost, static_cast<std::int32_t>(p % 3)}
                          : some_move(p);
      });
  CodingParameters plain = frame_parameters(0);
  plain.geometry_level_ends = {3, 5};
  FrameWriter geometry(plain, 0, kMovedPoints);
  geometry.add(still(0));
  geometry.add_moved(frame_field(turned, 0), onwards(), some_move);
  Case c = frame_case("frames-moved-geometry", "no components", geometry, {"8.12.7"});
  c.levels = {2};
  cases.push_back(c);
  FrameWriter unlike(frame_parameters(2), 0, kMovedPoints);
  unlike.add(still());
  unlike.add_moved(frame_field(turned), onwards(), some_move);
  cases.push_back(frame_case("frames-moved-without-contexts", "no contexts by the reference",
                             unlike, {"8.12.7", "7.2.1"}));
  add_levels(cases);
  cases.push_back(attributes_case(true));
  return cases;
}

std::vector<Case> frame_attribute_cases() { return {attributes_case(false)}; }

std::vector<RefusedCase> refused_moves() {
  std::vector<RefusedCase> cases;
  CodingParameters parameters = frame_parameters(1);
  parameters.digest = false;
  FrameWriter writer = moved_writer(parameters);
  writer.add(still(1));
  const std::size_t points = still(1).num_points();
  // One point leaves the grid, whether by the most that a vector has or by more.
  const auto away = [](std::int32_t by) {
    return [by](std::size_t point) { return PointMove{point == 7 ? by : 0, 0, 0}; };
  };
  writer.add_moved(still(1), {}, away(1 << 21));
  const Bytes first = writer.frames()[0];
  const auto add = [&](const char* id, const char* purpose, const MovesOf& of,
                       const Bytes& behind = {}) {
    FrameHeader header;
    header.moves_points = true;
    for (std::size_t p = 0; p < points; ++p) header.moves.push_back(of(p));
    Bytes vectors = write_vectors({}, kFrameBits, header);
    vectors.insert(vectors.end(), behind.begin(), behind.end());
    UnitList units;
    for (std::size_t at = 0; at < writer.frames()[1].size();) {
      const Unit unit = *read_unit(writer.frames()[1], at);
      units.push_back({unit.type, {unit.payload.begin(), unit.payload.end()}});
      at += static_cast<std::size_t>(unit.bytes);
    }
    std::span<const std::uint8_t> old;
    const FrameHeader whole = *parse_frame_header(units[0].payload, old);
    units[0].payload = *frame_payload(whole, vectors);
    Bytes stream = first;
    for (const EditableUnit& unit : units) append_unit(stream, unit.type, unit.payload);
    cases.push_back({id, purpose, {"8.12.7", "7.13"}, std::move(stream), 1});
  };
  add("frames-moves-too-far", "a point moves by 2^21 + 1", away((1 << 21) + 1));
  add("frames-moves-longer", "bytes behind the vectors of points", away(1 << 21), Bytes(40, 0x55));
  const auto add_behind = [&](const char* id, const char* purpose, const char* clause, int minor,
                              const auto& edit) {
    const Bytes edited = edited_frame(first, [&](UnitList& units) { edit_sequence(units, edit); });
    cases.push_back({id,
                     purpose,
                     {"8.12.7", clause},
                     joined({of_version(edited, kVersionMajor, minor), writer.frames()[1]}),
                     1});
  };
  add_behind("frames-moves-without-feature", "points move, and the sequence says nothing of it",
             "7.13", 1, [](SequenceParameterSet& set) { set.features = kReferenceContexts; });
  add_behind("frames-moves-cut-levels", "points move, and levels were left out", "8.12.5", 3,
             [](SequenceParameterSet& set) {
               set.sps_cut_flag = 1;
               set.sps_cut_levels = 4;
             });
  return cases;
}

}  // namespace slf::conformance
