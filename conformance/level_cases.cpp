// SPDX-License-Identifier: Apache-2.0
// What a level admits, to the last row, and one more. Spec 9. Streams end behind the slices unit,
// which says how many rows there are: nobody has to decode a million points.
#include "bitstream/slice_headers.h"
#include "bitstream/unchecked_headers.h"
#include "conformance/cases.h"
#include "conformance/edit_frames.h"
#include "conformance/fields.h"

namespace slf::conformance {
namespace {

/// @param points  of each slice, of one base cell each where there are several
Bytes head(std::uint32_t level, int functions, const std::vector<std::uint32_t>& points) {
  CodingParameters p;
  if (functions > 0) p = with_steps(functions, 8);
  p.base_levels = points.size() > 1 ? 2 : 0;
  return edited(packed_bare(field(lattice(2, 3, 2), 10, functions), p), [&](UnitList& units) {
    SequenceParameterSet set = *parse_sequence_parameter_set(units[0].payload);
    set.sps_level = level;
    SliceTable table;
    table.slices_num_minus1 = static_cast<std::uint32_t>(points.size()) - 1;
    for (const std::uint32_t count : points) table.slices.push_back({0, count - 1});
    units.resize(2);
    units[0].payload = sequence_as_is(set);
    units[1] = {UnitType::kSlices, slice_table_as_is(table, set)};
  });
}

/// Two frames of 60 points.
Bytes frames(std::uint32_t level, double seconds) {
  FrameWriter writer(with_steps(1, 40), level);
  writer.add(field(lattice(3, 4, 5), 4, 1, 500));
  writer.add(field(lattice(3, 4, 5), 4, 1, 600), {});
  const auto later = [&](FrameHeader& h) { h.frame_time = seconds; };
  return joined({writer.frames()[0], edited_frame(
                                         writer.frames()[1], [](auto&) {}, later)});
}

constexpr std::uint32_t k2to20 = 1u << 20, k2to22 = 1u << 22;
constexpr double kShortest = 60.0 / k2to22;  // between frames of 60 points in level 1

}  // namespace

std::vector<Case> level_cases() {
  std::vector<Case> cases;
  const auto add = [&](const char* id, const char* purpose, Bytes stream) {
    cases.push_back(case_of_stream(id, purpose, {"9"}, std::move(stream)));
  };
  add("level-1-rows", "as many points as level 1 admits", head(1, 0, {k2to20}));
  add("level-1-values", "as many values", head(1, 64, {349525}));
  add("level-0-rows", "a point more, and no level", head(0, 0, {k2to20 + 1}));
  add("frames-level-1", "frames as fast as level 1 admits", frames(1, kShortest));
  cases.back().frames = 2;
  add("frames-level-0", "faster ones, and no level", frames(0, 0.99 * kShortest));
  cases.back().frames = 2;
  return cases;
}

std::vector<RefusedCase> refused_levels() {
  std::vector<RefusedCase> cases;
  const auto add = [&](const char* id, const char* purpose, Bytes stream) {
    cases.push_back({id, purpose, {"9"}, std::move(stream)});
  };
  add("level-1-rows-more", "a point more than level 1 admits", head(1, 0, {k2to20 + 1}));
  add("level-1-rows-with-cells", "as many points, and base cells",
      head(1, 0, {k2to20 / 2, k2to20 / 2}));
  add("level-1-values-more", "more values than level 1 admits", head(1, 64, {349526}));
  add("level-2-rows-more", "more rows than level 2 admits",
      head(2, 0, {k2to22, k2to22, k2to22, k2to22}));
  return cases;
}

RefusedCase refused_frame_rate() {
  return {"frames-level-1-faster",
          "frames faster than level 1 admits",
          {"9"},
          frames(1, 0.99 * kShortest),
          1};
}

}  // namespace slf::conformance
