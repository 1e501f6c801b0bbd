// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "codec/encoder/assemble.h"
#include "codec/encoder/pack_frame.h"
#include "codec/encoder/sorted_field.h"
#include "codec/encoder/use_transforms.h"

namespace slf {

Result<std::vector<std::uint8_t>, InputError> pack_predicted(
    const LightField& field, const CodingParameters& parameters, const GroupCoding& group,
    const FrameState& before, FrameHeader& frame, const ChooseMoves& choose) {
  SequenceParameterSet set = group.set;
  set.predicted = true;
  const int bits = static_cast<int>(set.grid_bits());
  SLF_TRY(SortedField sorted, sort_points(field));                              // 6.2
  SLF_TRY(const SceneLayout layout, lay_out(sorted.morton, bits, parameters));  // 7.3
  if (!group.transforms.empty())
    sorted.components =
        find_components(group.transforms, group.coded, static_cast<std::size_t>(field.num_planes()),
                        std::move(sorted.components), parameters.threads);  // 8.7.5
  frame.moves_points = choose != nullptr;
  if (choose) frame.moves = choose(sorted.morton, sorted.components);  // 8.12.7
  // The vectors that are not coded are known after this; the length of the frame is not yet.
  SLF_CHECK(write_frame_header(frame, &before.cells, bits));  // 7.13
  MovedFrame moved;
  if (choose) moved = move_frame(before, frame.moves, frame.motion, bits, group.steps.size());
  LevelTerms terms;
  const FrameReference reference = choose ? FrameReference(before, moved, bits, terms)
                                          : FrameReference(before, frame.motion, bits, terms);
  SliceCoding coding{
      set, group.groups, group.steps, parameters.digest, parameters.texture, parameters.rdo};
  coding.reference = &reference;
  std::vector<std::uint8_t> rest;
  SLF_TRY(const auto table, write_slice_table(layout.table, set));
  append_unit(rest, UnitType::kSlices, table);
  SLF_TRY(const auto parts, code_scene(sorted, layout, coding, parameters.threads));  // 8.4 - 8.10
  for (const CodedUnit& unit : parts) append_unit(rest, unit.type, unit.payload);
  append_unit(rest, UnitType::kEnd, end_payload(parts.size() + 2));
  frame.frame_bytes = static_cast<std::uint32_t>(rest.size());
  std::vector<std::uint8_t> bytes;
  SLF_TRY(const auto header, write_frame_header(frame, &before.cells, bits));
  append_unit(bytes, UnitType::kFrame, header);
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}

}  // namespace slf
