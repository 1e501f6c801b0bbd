// SPDX-License-Identifier: Apache-2.0
// Contexts by the reference: whatever it may have, or not have, in the place of a coefficient.
// Spec 8.12.6.
#include "conformance/fields.h"
#include "conformance/frame_fields.h"

namespace slf::conformance {
namespace {

FrameWriter writer_of(const CodingParameters& parameters) {
  return FrameWriter(parameters, 0, kReferenceContexts);
}

Voxel turned_twice(const Voxel& v) { return turned(turned(v)); }

/// Values from far below a step to far above it.
LightField of_all_sizes(LightField field) {
  for (std::size_t i = 0; i < field.components.size(); ++i)
    field.components[i] += (i / 3 % 2 == 0 ? 1 : -1) * (1 << (i / 24 % 15));
  return field;
}

Case levels_case() {
  CodingParameters p = frame_parameters(2);
  p.geometry_level_ends = {2, 4, 5};
  p.coefficient_level_ends = {1, 4, 5};
  FrameWriter writer = writer_of(p);
  writer.add(still());
  writer.add(frame_field(turned), turn());
  writer.add(frame_field(turned_twice), turn());
  Case c = frame_case("frames-contexts-levels", "units of several levels, asked for in part",
                      writer, {"8.12.6", "8.12.5"});
  c.levels = {1, 2, 3, 4};
  c.groups = {1};
  c.regions = {{{0, 0, 0}, {15, 20, 31}}};
  return c;
}

Case groups_case() {
  CodingParameters p = frame_parameters(6);
  p.group = {0, 1, 1, 1, 1, 2};
  FrameWriter writer = writer_of(p);
  LightField zeros = still(6);
  for (std::size_t i = 0; i < zeros.components.size(); ++i)
    if (i % 18 >= 15) zeros.components[i] = 0;
  writer.add(zeros);
  writer.add(frame_field(turned, 6), turn());
  writer.add(still(6));
  writer.add(frame_field(bent, 6), lattice_motion(3, {0, 1, 0}, {6, 3, 5}));
  Case c = frame_case("frames-contexts-groups", "groups of functions, in two groups of frames",
                      writer, {"8.12.6"});
  c.groups = {1, 2};
  return c;
}

}  // namespace

std::vector<Case> frame_context_cases() {
  std::vector<Case> cases = {levels_case(), groups_case()};
  const auto add = [&](const char* id, const char* purpose, const CodingParameters& parameters,
                       const LightField& first, const LightField& second, const Motion& motion) {
    FrameWriter writer = writer_of(parameters);
    writer.add(first);
    writer.add(second, motion);
    writer.add(first, motion);
    cases.push_back(frame_case(id, purpose, writer, {"8.12.6"}));
  };
  const CodingParameters plain = frame_parameters(2);
  CodingParameters fine = plain, unpredicted = plain;
  fine.step.assign(2, {3, 40, 500});
  unpredicted.predict = false;
  add("frames-contexts", "contexts by the reference", plain, still(), frame_field(turned), turn());
  add("frames-contexts-sizes", "coefficients of all sizes", fine, of_all_sizes(still()),
      of_all_sizes(frame_field(turned)), turn());
  add("frames-contexts-unpredicted", "levels are not predicted, contexts know the reference",
      unpredicted, still(), frame_field(bent), {});
  Motion far = turn();
  far.shift = {100, -120, 40};
  add("frames-contexts-beside", "the reference has a part of what is asked for", plain, still(),
      frame_field(turned), far);
  const LightField point = field({{9, 17, 30}}, kFrameBits, 2);
  add("frames-contexts-of-one-point", "points appear, and all but one vanish", plain, point,
      still(), {});
  return cases;
}

}  // namespace slf::conformance
