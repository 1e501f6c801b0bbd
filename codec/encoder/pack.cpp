// SPDX-License-Identifier: Apache-2.0
// The coder's main path, from integers to bytes. Mirrors codec/decoder/decode.cpp.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "bitstream/index.h"
#include "bitstream/metadata.h"
#include "codec/encoder/assemble.h"
#include "codec/encoder/index_boxes.h"
#include "codec/encoder/pack_frame.h"
#include "codec/encoder/pack_parameters.h"
#include "codec/encoder/sorted_field.h"
#include "codec/encoder/texture_parameters.h"
#include "codec/encoder/use_transforms.h"
#include "codec/sequence.h"
#include "slf/encoder.h"

namespace slf {
namespace {

/// What a texture is coded with beside the steps, which have to fit its samples.
Result<Done, InputError> choose_texture(const SortedField& sorted, int bits,
                                        SequenceParameterSet& set) {
  const auto steps = plane_steps(set);
  const auto least = least_texture_steps(sorted.components, steps.size(), bits);
  for (std::size_t j = 0; j < steps.size(); ++j)
    if (steps[j] < least[j])
      return InputError{Errc::kInvalidArgument,
                        "steps: plane " + std::to_string(j) + " of the texture needs at least " +
                            std::to_string(least[j]) + " with " + std::to_string(bits) + " bits"};
  set.sps_texture_cell_log2 = static_cast<std::uint32_t>(
      texture_cell_log2(sorted.morton, static_cast<int>(set.grid_bits())));
  return Done{};
}

/// What follows the sorting.
/// @param field  perhaps without its points
Result<std::vector<std::uint8_t>, InputError> pack_sorted(const LightField& field,
                                                          SequenceParameterSet set,
                                                          SortedField sorted,
                                                          const CodingParameters& parameters,
                                                          FrameHeader* frame, GroupCoding* group) {
  SLF_TRY(const SceneLayout layout,
          lay_out(sorted.morton, field.header.grid.bits, parameters));  // 7.3
  set_base(layout, set);
  if (group != nullptr) {
    set.sps_level = group->level;
    set.features = group->features;
  }
  if (set.has_texture()) SLF_CHECK(choose_texture(sorted, parameters.texture.bits, set));
  SliceCoding coding{
      set,           plane_groups(set), plane_steps(set), parameters.digest, parameters.texture,
      parameters.rdo};
  std::vector<CodedUnit> units;
  SLF_TRY(ChosenTransforms chosen,
          choose_transforms(field, {sorted.morton, sorted.components, layout.cuts}, layout,
                            parameters, set, coding, units));  // 7.11
  if (!chosen.transforms.empty())
    sorted.components = find_components(chosen.transforms, chosen.coded,
                                        static_cast<std::size_t>(field.num_planes()),
                                        std::move(sorted.components), parameters.threads);
  if (group != nullptr)
    *group = {group->level,  group->features, set,
              coding.groups, coding.steps,    std::move(chosen.transforms),
              chosen.coded};
  SLF_TRY(auto table, write_slice_table(layout.table, set));  // 7.3
  units.push_back({UnitType::kSlices, std::move(table), {}});
  SLF_TRY(auto parts, code_scene(sorted, layout, coding, parameters.threads));  // 8.4 - 8.10
  std::move(parts.begin(), parts.end(), std::back_inserter(units));
  if (!parameters.metadata.empty())
    units.push_back({UnitType::kMetadata, write_metadata(parameters.metadata), {}});  // 7.8
  std::optional<std::vector<CellBox>> boxes;
  if (parameters.index) boxes = boxes_of(layout);
  if (frame != nullptr) {
    SLF_TRY(CodedUnit unit, frame_unit_before(units, *frame));  // 7.13
    units.insert(units.begin(), std::move(unit));
  }
  return assemble(set, units, boxes);  // 7.1, 7.7
}

}  // namespace

Result<CodedUnit, InputError> frame_unit_before(std::span<const CodedUnit> units,
                                                FrameHeader& frame) {
  std::uint64_t bytes = unit_bytes(UnitType::kEnd, end_payload(units.size() + 2).size());
  for (const CodedUnit& unit : units) bytes += unit_bytes(unit.type, unit.payload.size());
  frame.frame_bytes = static_cast<std::uint32_t>(bytes);
  SLF_TRY(auto payload, write_frame_header(frame, nullptr, 0));
  return CodedUnit{UnitType::kFrame, std::move(payload), {}};
}

Result<std::vector<std::uint8_t>, InputError> pack(const LightField& field,
                                                   const CodingParameters& parameters) {
  return pack_frame(field, parameters, nullptr, nullptr);
}

Result<std::vector<std::uint8_t>, InputError> pack_frame(const LightField& field,
                                                         const CodingParameters& parameters,
                                                         FrameHeader* frame, GroupCoding* group) {
  SLF_TRY(SequenceParameterSet set, sequence_of(field, parameters));  // 7.2
  SLF_TRY(SortedField sorted, sort_points(field));                    // 6.2
  return pack_sorted(field, std::move(set), std::move(sorted), parameters, frame, group);
}

Result<std::vector<std::uint8_t>, InputError> pack_taken(LightField field,
                                                         const CodingParameters& parameters) {
  SLF_TRY(SequenceParameterSet set, sequence_of(field, parameters));  // 7.2
  SLF_TRY(SortedField sorted, take_points(field));                    // 6.2
  return pack_sorted(field, std::move(set), std::move(sorted), parameters, nullptr, nullptr);
}

}  // namespace slf
