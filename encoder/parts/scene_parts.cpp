// SPDX-License-Identifier: Apache-2.0
#include "encoder/parts/scene_parts.h"

#include <algorithm>
#include <utility>

#include "base/error_words.h"
#include "codec/decoder/request.h"
#include "codec/encoder/assemble.h"
#include "codec/encoder/base_encoder.h"
#include "codec/sequence.h"
#include "codec/split_frames.h"
#include "encoder/parts/part_sums.h"

namespace slf {
namespace {

InputError wrong(const std::string& name, const std::string& cause) {
  return {Errc::kInvalidInput, name + ": " + cause};
}

CodedUnit copy_of(const Unit& unit) {
  return {unit.type, {unit.payload.begin(), unit.payload.end()}, {}};
}

/// A part as it is read.
class PartReader {
 public:
  PartReader(const PartStream& part, SceneParts& parts, std::uint64_t max_memory)
      : part_(part), parts_(parts), max_memory_(max_memory) {}

  /// Errors: it is no part; it is one, and not whole.
  static constexpr const char* kNoPart = "part_plan";
  static constexpr const char* kNotWhole = "part_units";

  Result<Done> read() {
    SLF_TRY(const FrameUnits first, first_frame(part_.bytes));
    if (first.moves())
      return of_unit(first.unit.type, first.unit.offset, Errc::kUnsupported, kOneLightField);
    SLF_TRY(units_, split_units(part_.bytes, 0, max_memory_));
    SLF_TRY(cut_, find_sequence(units_));
    if (const auto& s = cut_; s.sps_cut_flag != 0 && (s.sps_cut_levels != s.grid_bits() ||
                                                      s.sps_cut_groups + s.sps_cut_layers > 0))
      return Error{Errc::kTruncated, kNotWhole};
    SLF_TRY(scene_, collect_units(units_, cut_));
    SLF_TRY(parts_.metadata, collect_metadata(units_));
    parts_.table = scene_.stream.table;
    parts_.set = cut_;
    parts_.set.sps_cut_flag = parts_.set.sps_cut_levels = parts_.set.sps_cut_slices_flag = 0;
    layout_ = layout_of(parts_.set);
    SLF_TRY(const Request request, request_of(units_, scene_, {}));
    SLF_CHECK(read_head(request));
    return read_slices();
  }

 private:
  Result<Done> read_head(const Request& request) {
    bool found = false;
    for (const Unit& unit : units_.units) {
      if (unit.type == UnitType::kTransform || unit.type == UnitType::kSlices)
        parts_.head.push_back(copy_of(unit));
      if (!is_of_application(unit, kPartSums)) continue;
      if (found) return Error{Errc::kOutOfRange, "unit_type"};
      found = true;
      SLF_TRY(sums_, parse_part_sums(application_payload(unit), parts_.table, request.planes()));
    }
    if (!found) return Error{Errc::kTruncated, units_.complete ? kNoPart : kNotWhole};
    parts_.plan = sums_.plan;
    parts_.rdo = sums_.rdo;
    if (cut_.sps_transform_flag != 0) parts_.matrices.resize(request.groups.size());
    if (!is_whole(slots_of(layout_, Owner::kBase), scene_.base.size()))
      return Error{Errc::kTruncated, kNotWhole};  // matrices, too, stand there
    for (const PartUnit& unit : scene_.base) {
      if (unit.type == UnitType::kGeometry)
        parts_.base.push_back({unit.type, payload_at(unit), unit.header});
      if (unit.type == UnitType::kCoefficients && unit.header.range == 0 &&
          unit.header.group < parts_.matrices.size())
        parts_.matrices[unit.header.group] = {unit.matrix.begin(), unit.matrix.end()};
    }
    return Done{};
  }

  Result<Done> read_slices() {
    parts_.slices.resize(scene_.slices.size());
    for (SliceSums& sums : sums_.slices) {
      const PartUnits& units = scene_.slices[sums.slice];
      if (!is_whole(slots_of(layout_, Owner::kSlice), units.size()))
        return Error{Errc::kTruncated, kNotWhole};
      ScenePiece piece;
      for (const PartUnit& unit : units)
        piece.units.push_back({unit.type, payload_at(unit), unit.header});
      if (!sums.digest.empty()) {
        SliceUnitHeader header;
        header.slice_id = static_cast<std::uint32_t>(sums.slice);
        SLF_TRY(piece.digest,
                of_what_was_read(part_unit(UnitType::kDigest, header, sums.digest, parts_.set)));
      }
      piece.sums = std::move(sums.sums);
      piece.from = part_.name;
      parts_.slices[sums.slice] = std::move(piece);
    }
    return Done{};
  }

  /// The payload of the whole unit that a part unit was read from.
  std::vector<std::uint8_t> payload_at(const PartUnit& part) const {
    const auto unit =
        std::lower_bound(units_.units.begin(), units_.units.end(), part.offset,
                         [](const Unit& u, std::size_t offset) { return u.offset < offset; });
    return {unit->payload.begin(), unit->payload.end()};
  }

  const PartStream& part_;
  SceneParts& parts_;
  std::uint64_t max_memory_;
  Units units_;
  SequenceParameterSet cut_;
  SceneUnits scene_;
  UnitLayout layout_;  // of the whole
  PartSums sums_;
};

bool same_units(const std::vector<CodedUnit>& a, const std::vector<CodedUnit>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.type == y.type && x.payload == y.payload;
  });
}

}  // namespace

std::vector<std::size_t> SceneParts::missing() const {
  std::vector<std::size_t> none;
  for (std::size_t s = 0; s < slices.size(); ++s)
    if (!slices[s]) none.push_back(s);
  return none;
}

Result<SceneParts, InputError> parts_of(const PlannedScene& scene) {
  SceneParts parts;
  parts.plan = digest_of(scene.plan);
  parts.rdo = scene.coding->rdo;
  parts.set = scene.set;
  parts.table = scene.cells.layout.table;
  parts.head = scene.head;
  SLF_TRY(EncodedBase base, encode_base_geometry(*scene.coding, scene.cells.layout));
  parts.base = std::move(base.units);
  parts.matrices = scene.coding->matrices;
  parts.metadata = scene.plan.metadata;
  parts.slices.resize(parts.table.slices.size());
  return parts;
}

void add_slice(SceneParts& parts, CodedSlice slice) {
  ScenePiece piece;
  for (CodedUnit& unit : slice.units) {
    if (unit.type == UnitType::kDigest)
      piece.digest = std::move(unit);
    else
      piece.units.push_back(std::move(unit));
  }
  piece.sums = std::move(slice.sums);
  parts.slices[slice.slice] = std::move(piece);
}

std::uint64_t memory_of(const SceneParts& parts) {
  std::uint64_t bytes = 0;
  for (const auto& piece : parts.slices)
    if (piece)
      for (const CodedUnit& unit : piece->units) bytes += kMemoryOfPartUnit + unit.payload.size();
  return bytes;
}

Result<SceneParts, InputError> read_part(const PartStream& part, std::uint64_t max_memory) {
  SceneParts parts;
  parts.name = part.name;
  if (const auto read = PartReader(part, parts, max_memory).read(); !read) {
    if (read.error().code == Errc::kLimitExceeded)
      return InputError{Errc::kLimitExceeded,
                        part.name + ": its units take more memory than the limit"};
    const std::string_view element = read.error().element;
    if (element == PartReader::kNoPart) return wrong(part.name, "not a part of a scene");
    if (element == PartReader::kNotWhole)
      return wrong(part.name, "it was cut: units of it are missing, and parts are merged whole");
    return InputError{read.error().code, part.name + ": " + in_words(read.error())};
  }
  return parts;
}

Result<Done, InputError> combine(SceneParts& parts, SceneParts more) {
  if (parts.plan != more.plan || parts.slices.size() != more.slices.size() ||
      !same_units(parts.head, more.head) || !same_units(parts.base, more.base) ||
      parts.matrices != more.matrices || parts.metadata != more.metadata)
    return wrong(more.name, "a part of another plan than " + parts.name);
  // A part may have been annotated: what one says of the scale is of all, whatever their order.
  if (more.set.sps_metres_flag != 0) {
    if (parts.set.sps_metres_flag != 0 &&
        parts.set.sps_metres_per_unit != more.set.sps_metres_per_unit)
      return wrong(more.name, "its metres_per_unit are not those of the parts before it");
    parts.set.sps_metres_flag = more.set.sps_metres_flag;
    parts.set.sps_metres_per_unit = more.set.sps_metres_per_unit;
  }
  for (std::size_t s = 0; s < more.slices.size(); ++s) {
    if (!more.slices[s]) continue;
    if (parts.slices[s])
      return wrong(more.name,
                   "slice " + std::to_string(s) + " is in " + parts.slices[s]->from + " too");
    parts.slices[s] = std::move(more.slices[s]);
  }
  return Done{};
}

}  // namespace slf
