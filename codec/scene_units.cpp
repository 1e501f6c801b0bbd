// SPDX-License-Identifier: Apache-2.0
#include "codec/scene_units.h"

#include <utility>

#include "bitstream/index.h"
#include "bitstream/level.h"
#include "codec/split_frames.h"

namespace slf {
namespace {

Error at(const Unit& unit, const char* element) {
  return of_unit(unit.type, unit.offset, Errc::kOutOfRange, element);
}

/// The element that is wrong in a unit which is not the one expected.
const char* misplaced(UnitType type, UnitType expected) {
  if (type != expected || type == UnitType::kDigest) return "unit_type";
  if (type == UnitType::kRefinement) return "refinement_layer";
  return type == UnitType::kGeometry ? "level_range" : "plane_group";
}

/// Spec 7.1: every unit is the next of its owner's slots.
class Collector {
 public:
  explicit Collector(const SequenceParameterSet& set)
      : set_(set), limits_(level_limits(set.sps_level)) {
    scene_.stream.set = set;
    scene_.stream.layout = layout_of(set);
    head_ = scene_.stream.slots(Owner::kHead);
    base_ = scene_.stream.slots(Owner::kBase);
    slice_ = scene_.stream.slots(Owner::kSlice);
  }

  Result<Done> add(const Unit& unit) {
    ++units_;
    if (unit.payload.size() > limits_.unit_bytes) return at(unit, "unit_length");  // 9
    if (is_head(unit.type)) return add_head(unit);
    if (unit.type == UnitType::kFrame) return check_frame(unit);
    if (unit.type == UnitType::kEnd) return check_end(unit);
    if (has_ids(unit.type)) return add_part(unit);
    return check_understood(unit.type, unit.offset);  // others stand anywhere
  }

  SceneUnits take(const Units& units) {
    for (const Unit& unit : units.units) scene_.stream.units += 1 + listed_units(unit);
    if (!units.units.empty())
      scene_.stream.bytes = units.units.back().offset + units.units.back().bytes;
    scene_.stream.complete = units.complete && !set_.sps_cut_flag;
    return std::move(scene_);
  }

 private:
  static bool is_head(UnitType type) {
    return type == UnitType::kSequence || type == UnitType::kTransform || type == UnitType::kSlices;
  }

  bool head_is_whole() const { return heads_ == head_.size(); }

  /// That of a predicted frame, which the sequence of another stands before, was looked at there.
  Result<Done> check_frame(const Unit& unit) {
    if (!set_.predicted && units_ != 2) return at(unit, "unit_type");
    moves_ = true;
    return Done{};
  }

  Result<Done> add_head(const Unit& unit) {
    if (head_is_whole()) return at(unit, "unit_type");
    const UnitType expected = head_[heads_++].type;
    if (expected == UnitType::kTransform && unit.type == UnitType::kSlices)
      return of_sequence(Errc::kOutOfRange, "sps_num_transforms_minus1");
    if (unit.type != expected) return at(unit, "unit_type");
    if (unit.type != UnitType::kSlices) return Done{};
    SLF_TRY(scene_.stream.table, in_unit(unit, parse_slice_table(unit.payload, set_)));
    scene_.stream.table.offset = unit.offset;
    const std::uint64_t rows = scene_.stream.table.num_points() + scene_.stream.num_cells();
    if (!limits_.admits(rows, set_.sps_num_functions))  // 9
      return of_sequence(Errc::kOutOfRange, "sps_level");
    scene_.slices.resize(scene_.stream.table.slices.size());
    return Done{};
  }

  Result<Done> add_part(const Unit& unit) {
    if (!head_is_whole()) return at(unit, "unit_type");
    SLF_TRY(PartUnit read, read_part_unit(unit, set_));
    const bool of_base = read.header.of_base();
    if (!of_base && read.header.slice_id >= scene_.slices.size()) return at(unit, "slice_id");
    if (of_base ? in_slices_ : scene_.base.size() < base_.size()) return at(unit, "unit_type");
    in_slices_ = !of_base;
    PartUnits& units = of_base ? scene_.base : scene_.slices[read.header.slice_id];
    SLF_CHECK(check_slot(unit, read.header, units.size(), of_base ? base_ : slice_));
    units.push_back(std::move(read));
    return Done{};
  }

  Result<Done> check_slot(const Unit& unit, const SliceUnitHeader& ids, std::size_t next,
                          std::span<const UnitSlot> slots) const {
    if (next >= slots.size()) return at(unit, "unit_type");
    if (slot_of(unit.type, ids) != slots[next])
      return at(unit, misplaced(unit.type, slots[next].type));
    const bool follows_slice_0 = scene_.stream.table.shared() && !ids.of_base() &&
                                 ids.slice_id > 0 && unit.type != UnitType::kNormals &&
                                 unit.type != UnitType::kDigest;
    if (follows_slice_0 && scene_.slices[0].size() <= next) return at(unit, "slice_id");
    return Done{};
  }

  Result<Done> check_end(const Unit& unit) const {
    if (set_.is_empty_frame() && !moves_) return at(unit, "unit_type");  // 7.13
    if (set_.sps_cut_flag) return Done{};
    bool whole = head_is_whole() && is_whole(base_, scene_.base.size());
    for (const PartUnits& units : scene_.slices) whole = whole && is_whole(slice_, units.size());
    if (!whole) return at(unit, "unit_type");
    return Done{};
  }

  SceneUnits scene_;
  const SequenceParameterSet& set_;
  const LevelLimits& limits_;
  std::span<const UnitSlot> head_, base_, slice_;
  std::size_t heads_ = 0;  // units of the head so far
  std::size_t units_ = 0;  // of all
  bool in_slices_ = false;
  bool moves_ = false;  // there is a frame unit
};

/// Spec 7.13: what predicted frames are not made for.
Result<Done> check_frames(const SequenceParameterSet& set) {
  if (set.sps_profile != 0) return of_sequence(Errc::kOutOfRange, "sps_profile");
  if (set.sps_base_levels != 0) return of_sequence(Errc::kOutOfRange, "sps_base_levels");
  if (!set.has_vectors() || set.num_layers() > 1)
    return of_sequence(Errc::kOutOfRange, "sps_coefficient_coder");
  return Done{};
}

}  // namespace

Result<SequenceParameterSet> find_sequence(const Units& units) {
  if (units.units.empty()) return Error{Errc::kTruncated, "unit_type", 8 * kSignature.size()};
  if (units.units.front().type != UnitType::kSequence) return at(units.units.front(), "unit_type");
  for (std::size_t i = 1; i < units.units.size(); ++i)
    if (units.units[i].type == UnitType::kSequence) return at(units.units[i], "unit_type");
  const Unit& unit = units.units.front();
  return in_unit(unit, parse_sequence_parameter_set(unit.payload));
}

Result<Metadata> collect_metadata(const Units& units) {
  const Unit* found = nullptr;
  for (const Unit& unit : units.units) {
    if (unit.type != UnitType::kMetadata) continue;
    if (found != nullptr) return at(unit, "unit_type");
    found = &unit;
  }
  if (found == nullptr) return Metadata{};
  return in_unit(*found, parse_metadata(found->payload));
}

Result<PartUnit> read_part_unit(const Unit& unit, const SequenceParameterSet& set) {
  BitReader in(unit.payload);
  ParseSyntax parse{in};
  PartUnit read{unit.type, {}, {}, {}, unit.offset, unit.payload_offset};
  slice_unit_header(parse, read.header, unit.type, set);
  const auto rest = in.align_and_rest("alignment_zero_bits");
  if (in.ok() && read.header.cu_matrix_bytes > rest.size())
    in.fail(Errc::kTruncated, "cu_matrix_bytes");
  if (!in.ok()) return in_unit(unit, in.error());
  read.matrix = rest.first(read.header.cu_matrix_bytes);
  read.payload = rest.subspan(read.matrix.size());
  read.payload_offset += unit.payload.size() - read.payload.size();
  return read;
}

Result<SceneUnits> collect_units(const Units& units, const SequenceParameterSet& set) {
  Collector collector(set);
  for (const Unit& unit : units.units) SLF_CHECK(collector.add(unit));
  return collector.take(units);
}

Result<OpenStream> open_stream(std::span<const std::uint8_t> stream, const DecodeLimits& limits,
                               std::uint64_t max_bytes) {
  if (stream.size() > limits.max_stream_bytes) return Error{Errc::kLimitExceeded, "stream"};
  SLF_TRY(const FrameUnits first, first_frame(stream));  // 7.13
  const auto bytes = stream.first(static_cast<std::size_t>(first.bytes));
  SLF_TRY(Units units, split_units(bytes, max_bytes, limits.max_memory));  // 7.1
  SLF_CHECK(check_frame_bytes(first, units));                              // 7.13
  SLF_TRY(const SequenceParameterSet set, find_sequence(units));           // 7.2
  if (first.moves()) SLF_CHECK(check_frames(set));                         // 7.13
  SLF_TRY(SceneUnits scene, collect_units(units, set));                    // 7.3 - 7.6
  SLF_CHECK(check_index(units, set, scene.slices.size()));                 // 7.7
  return OpenStream{std::move(units), std::move(scene)};
}

}  // namespace slf
