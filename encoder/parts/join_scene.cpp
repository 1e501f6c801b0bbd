// SPDX-License-Identifier: Apache-2.0
// Slices to one stream: the base, which they have together, is coded here.
#include <algorithm>
#include <iterator>
#include <optional>

#include "base/error_words.h"
#include "bitstream/metadata.h"
#include "codec/decoder/base_decoder.h"
#include "codec/decoder/decode_cost.h"
#include "codec/encoder/assemble.h"
#include "codec/encoder/base_encoder.h"
#include "codec/encoder/index_boxes.h"
#include "encoder/parts/part_sums.h"
#include "encoder/parts/scene_parts.h"
#include "geometry/weight_classes.h"

namespace slf {
namespace {

InputError damaged(const Error& error) {
  return {Errc::kInvalidInput, "the base of the parts: " + in_words(error)};
}

/// What the sequence says of a stream that slices are missing from.
SequenceParameterSet cut_slices(SequenceParameterSet set) {
  set.sps_cut_flag = 1;
  set.sps_cut_levels = set.grid_bits();
  set.sps_cut_slices_flag = 1;
  return set;
}

/// A stream with the head and the geometry of the base alone, to be read as a decoder reads it.
Result<std::vector<std::uint8_t>, InputError> beginning(const SceneParts& parts) {
  std::vector<CodedUnit> units = parts.head;
  units.insert(units.end(), parts.base.begin(), parts.base.end());
  return assemble(cut_slices(parts.set), units, std::nullopt);
}

/// The layout as the base's geometry tells it.
SceneLayout known_layout(const SceneParts& parts, BaseState base) {
  SceneLayout layout;
  layout.base_levels = base.level;
  layout.cells = std::move(base.cells);
  layout.weight_before = std::move(base.weight_before);
  layout.table = parts.table;
  std::size_t cell = 0, point = 0;
  for (const SliceEntry& slice : parts.table.slices) {
    layout.cuts.push_back({cell, point, point + slice.points()});
    cell += slice.cells();
    point += slice.points();
  }
  return layout;
}

/// [cells][planes] of all slices that are there; 0 of the others.
std::vector<std::int32_t> base_input(const SceneParts& parts, const SceneLayout& layout,
                                     std::size_t planes) {
  std::vector<std::int32_t> input(layout.cells.size() * planes);
  for (std::size_t s = 0; s < parts.slices.size(); ++s)
    if (parts.slices[s])
      std::copy(parts.slices[s]->sums.begin(), parts.slices[s]->sums.end(),
                input.begin() + static_cast<std::ptrdiff_t>(layout.cuts[s].first_cell * planes));
  return input;
}

void add_slices(const SceneParts& parts, bool digests, std::vector<CodedUnit>& units) {
  std::vector<std::vector<CodedUnit>> of_slice;
  for (const auto& piece : parts.slices) {
    if (!piece) continue;
    of_slice.push_back(piece->units);
    if (digests && piece->digest) of_slice.back().push_back(*piece->digest);
  }
  append_slices(std::move(of_slice), units);
}

CodedUnit part_of(const SceneParts& parts) {
  PartSums sums{parts.plan, parts.rdo, {}};
  for (std::size_t s = 0; s < parts.slices.size(); ++s) {
    if (!parts.slices[s]) continue;
    sums.slices.push_back({s, {}, parts.slices[s]->sums});
    if (const auto& digest = parts.slices[s]->digest)
      sums.slices.back().digest.assign(digest->payload.end() - 32, digest->payload.end());
  }
  return {kApplicationUnit, with_identifier(kPartSums, write_part_sums(sums)), {}};
}

}  // namespace

Result<SceneBase, InputError> code_base(const SceneParts& parts, int threads) {
  SLF_TRY(const auto head, beginning(parts));
  const auto read = split_units(head);
  if (!read) return damaged(read.error());
  const auto scene = collect_units(*read, cut_slices(parts.set));
  if (!scene) return damaged(scene.error());
  const auto request = request_of(*read, *scene, {});
  if (!request) return damaged(request.error());
  auto known = decode_base_geometry(scene->base, *request);
  if (!known) return damaged(known.error());
  if (!known->is_known(scene->stream)) return damaged({Errc::kTruncated, "gu_occupancy"});
  const TextureSettings no_texture;
  const SliceCoding coding{parts.set,  request->groups, request->steps, true,
                           no_texture, parts.rdo,       parts.matrices};
  SceneBase base{known_layout(parts, *std::move(known)), coding.planes(), {}};
  EncodedBase coded{OccupancyStates(1), parts.base, {}, {}, {}, {}};
  SLF_CHECK(encode_base_components(coding, base.layout, base_input(parts, base.layout, base.planes),
                                   threads, coded));
  base.units = std::move(coded.units);
  return base;
}

Result<std::vector<std::uint8_t>, InputError> join(const SceneParts& parts, const SceneBase& base,
                                                   bool as_part) {
  const bool partial = as_part || !parts.missing().empty();
  std::vector<CodedUnit> body = base.units;
  add_slices(parts, !partial, body);
  std::vector<CodedUnit> units = parts.head;
  std::move(body.begin(), body.end(), std::back_inserter(units));
  if (!parts.metadata.empty())
    units.push_back({UnitType::kMetadata, write_metadata(parts.metadata), {}});
  if (as_part) units.push_back(part_of(parts));
  std::optional<std::vector<CellBox>> boxes;
  if (!as_part) boxes = boxes_of(base.layout);
  return assemble(partial ? cut_slices(parts.set) : parts.set, units, boxes);
}

}  // namespace slf
