// SPDX-License-Identifier: Apache-2.0
// Frames without points: first, last, between others, with all that their sequence may say, and
// what is none. Spec 7.13.
#include "bitstream/metadata.h"
#include "codec/encoder/assemble.h"
#include "conformance/fields.h"
#include "conformance/frame_fields.h"
#include "slf/frames.h"

namespace slf::conformance {
namespace {

/// An intra frame whose units are changed, the version as its features need it.
Bytes edited_intra(const Bytes& frame, const UnitEdit& edit) {
  return of_version(edited_frame(frame, edit), kVersionMajor, 2);
}

/// Two frames, none, two frames: somebody leaves and comes back.
std::vector<Bytes> leaves_and_comes_back() {
  CodingParameters p = frame_parameters(2);
  p.geometry_level_ends = p.coefficient_level_ends = {3, 5};
  FrameWriter writer(p);
  writer.add(still());
  writer.add(frame_field(turned), turn());
  writer.add_empty(still());
  writer.add(frame_field(turned));
  writer.add(still(), {});
  return writer.frames();
}

/// A stream of one frame, which is empty.
Bytes one_empty(const UnitEdit& edit = [](UnitList&) {}) {
  FrameWriter writer(frame_parameters(2));
  writer.add_empty(still());
  return edited_intra(writer.frames()[0], edit);
}

/// The stream of a sequence with the feature, and the end unit where `whole`: not a frame.
Bytes without_frame(bool whole, bool cut) {
  UnitList units;
  one_empty([&](UnitList& given) {
    if (cut)
      edit_sequence(given, [](SequenceParameterSet& set) {
        set.sps_cut_flag = 1;
        set.sps_cut_levels = 2;
      });
    units = given;
  });
  units.erase(units.begin() + 1);
  units.back().payload = end_payload(1);
  if (!whole) units.pop_back();
  return of_version(stream_of(units), kVersionMajor, 2);
}

/// What a sequence may say without a unit to show for it: transforms, ranges, groups, normals.
void say_much(SequenceParameterSet& set) {
  set.sps_normal_bits = 5;
  set.sps_num_geometry_ranges_minus1 = 2;
  set.sps_geometry_range_end = {1, 3};
  set.sps_num_coefficient_ranges_minus1 = 1;
  set.sps_coefficient_range_end = {4};
  set.sps_transform_flag = 1;
  set.sps_num_transforms_minus1 = 1;
}

Bytes with_all_around() {
  return one_empty([](UnitList& units) {
    const Bytes filler(70, 0x55);
    Index index{{{UnitType::kFiller, unit_bytes(UnitType::kFiller, filler.size()), {}},
                 {UnitType::kEnd, unit_bytes(UnitType::kEnd, 1), {}}},
                {}};
    const SequenceParameterSet set = *parse_sequence_parameter_set(units[0].payload);
    const UnitList around = {{UnitType::kMetadata, write_metadata({{"scene", "nobody"}})},
                             {static_cast<UnitType>(100), {1, 2, 3}},
                             {UnitType::kIndex, *write_index(index, set)},
                             {UnitType::kFiller, filler}};
    units.insert(units.begin() + 2, around.begin(), around.end());
  });
}

}  // namespace

std::vector<Case> empty_frame_cases() {
  std::vector<Case> cases;
  const auto add = [&](const char* id, const char* purpose, std::size_t frames, Bytes stream) {
    Case c = case_of_stream(id, purpose, {"7.13", "7.2.1"}, std::move(stream));
    c.frames = frames;
    cases.push_back(std::move(c));
  };
  const Bytes walk = joined(leaves_and_comes_back());
  add("frames-empty", "a frame without points among others", 5, walk);
  cases.back().levels = {2, 4};
  cases.back().groups = {1};
  cases.back().regions = {{{0, 0, 0}, {15, 20, 31}}};
  DecodeOptions fewer;
  fewer.levels = 3;
  fewer.groups = 1;
  add("frames-empty-cut", "levels and a group were left out, of a frame without points too", 5,
      *truncate_frames(walk, 0, 4, fewer));
  FrameWriter first(CodingParameters{});
  first.add_empty(still(0));
  first.add_empty(still(0));
  first.add(still(0));
  first.add_empty(still(0));
  add("frames-empty-first", "no functions; the first two frames and the last have no points", 4,
      first.stream());
  add("frames-empty-alone", "a stream of one frame, and that has no points", 1, one_empty());
  add("frames-empty-units", "metadata, an index, a filler and a unit to skip, but no points", 1,
      with_all_around());
  add("frames-empty-header", "transforms, ranges and normals that no unit shows", 1,
      one_empty([](UnitList& units) { edit_sequence(units, say_much); }));
  add("frames-empty-prefix", "the end unit of a frame without points is missing", 1,
      one_empty([](UnitList& units) { units.pop_back(); }));
  add("feature-empty-prefix", "a sequence of a frame without points, and nothing behind it", 1,
      without_frame(false, false));
  return cases;
}

std::vector<RefusedCase> refused_empty_frames() {
  std::vector<RefusedCase> cases;
  const auto add = [&](const char* id, const char* purpose, Bytes stream) {
    cases.push_back({id, purpose, {"7.13"}, std::move(stream)});
  };
  add("frames-empty-slices", "a slices unit in a frame without points",
      one_empty([](UnitList& units) {
        units.insert(units.begin() + 2, {UnitType::kSlices, {0xC0}});
      }));
  add("frames-empty-transform", "a transform unit in a frame without points",
      one_empty([](UnitList& units) {
        edit_sequence(units, say_much);
        units.insert(units.begin() + 2, {UnitType::kTransform, {0xD0}});
      }));
  add("frames-empty-base", "a base in a frame without points", one_empty([](UnitList& units) {
        edit_sequence(units, [](SequenceParameterSet& set) {
          set.sps_base_levels = 3;
          set.sps_num_geometry_ranges_minus1 = set.sps_num_coefficient_ranges_minus1 = 1;
          set.sps_geometry_range_end = set.sps_coefficient_range_end = {3};
        });
      }));
  add("feature-empty-without-frame", "no points, in a light field that does not move",
      without_frame(true, false));
  add("feature-empty-without-frame-cut", "the same, where units were left out",
      without_frame(true, true));
  return cases;
}

std::vector<RefusedCase> refused_behind_empty() {
  const std::vector<Bytes> frames = leaves_and_comes_back();
  FrameHeader header;
  header.frame_number = 3;
  header.frame_time = 0.75;
  header.frame_predicted_flag = 1;
  const Bytes end = end_payload(1);
  header.frame_bytes = static_cast<std::uint32_t>(unit_bytes(UnitType::kEnd, end.size()));
  Bytes bare;
  append_unit(bare, UnitType::kFrame, *frame_payload(header, {}));
  append_unit(bare, UnitType::kEnd, end);
  return {{"frames-predicted-from-empty",
           "a frame without units, predicted from one without points",
           {"7.13"},
           joined({frames[0], frames[1], frames[2], bare}),
           3}};
}

}  // namespace slf::conformance
