#include "codec/scene_units.h"

#include <algorithm>

namespace slf {
namespace {

Error at(const Unit& unit, const char* element) {
  return of_unit(unit.type, unit.offset, Errc::kOutOfRange, element);
}

/// What of a unit is wrong that is not the next of its list.
const char* misplaced(UnitType type, UnitType expected) {
  if (type != expected || type == UnitType::kDigest) return "unit_type";
  if (type == UnitType::kRefinement) return "refinement_layer";
  return type == UnitType::kGeometry ? "level_range" : "plane_group";
}

class Collector {
 public:
  explicit Collector(const SequenceParameterSet& set)
      : set_(set), base_(set, true), slice_(set, false) {}

  Result<Done> add(const Unit& unit) {
    if (unit.type == UnitType::kSlices) return add_table(unit);
    if (unit.type == UnitType::kEnd) return check_end(unit);
    return has_ids(unit.type) ? add_part(unit) : Done{};
  }

  SceneUnits take() { return std::move(scene_); }

 private:
  Result<Done> add_table(const Unit& unit) {
    if (!scene_.slices.empty()) return at(unit, "unit_type");
    SLF_TRY(scene_.table, in_unit(unit, parse_slice_table(unit.payload, set_)));
    scene_.table.offset = unit.offset;
    scene_.slices.resize(scene_.table.slices.size());
    return Done{};
  }

  Result<Done> add_part(const Unit& unit) {
    if (scene_.slices.empty()) return at(unit, "unit_type");
    SLF_TRY(PartUnit read, read_part_unit(unit, set_));
    const bool of_base = read.header.of_base();
    if (!of_base && read.header.slice_id >= scene_.slices.size()) return at(unit, "slice_id");
    if (of_base ? in_slices_ : scene_.base.size() < base_.size()) return at(unit, "unit_type");
    in_slices_ = !of_base;
    PartUnits& units = of_base ? scene_.base : scene_.slices[read.header.slice_id];
    SLF_CHECK(check_place(unit, read, units.size(), of_base ? base_ : slice_));
    units.push_back(std::move(read));
    return Done{};
  }

  Result<Done> check_place(const Unit& unit, const PartUnit& read, std::size_t next,
                           const PartList& list) const {
    const bool digest = unit.type == UnitType::kDigest;
    if (digest && set_.sps_cut_flag) return at(unit, "unit_type");
    if (list.place_of(read) != next || (next == list.size()) != digest)
      return at(unit, misplaced(unit.type, list.type_at(next)));
    const bool follows_slice_0 = scene_.table.shared() && !read.header.of_base() &&
                                 read.header.slice_id > 0 && unit.type != UnitType::kNormals &&
                                 !digest;
    if (follows_slice_0 && scene_.slices[0].size() <= next) return at(unit, "slice_id");
    return Done{};
  }

  Result<Done> check_end(const Unit& unit) const {
    if (set_.sps_cut_flag) return Done{};
    bool whole = !scene_.slices.empty() && scene_.base.size() >= base_.size();
    for (const PartUnits& units : scene_.slices) whole = whole && units.size() >= slice_.size();
    if (!whole) return at(unit, "unit_type");
    return Done{};
  }

  const SequenceParameterSet& set_;
  PartList base_, slice_;
  SceneUnits scene_;
  bool in_slices_ = false;
};

}  // namespace

PartList::PartList(const SequenceParameterSet& set, bool base)
    : first_geometry_(base ? 0 : set.base_geometry_ranges()),
      first_coefficients_(base ? 0 : set.base_coefficient_ranges()),
      groups_(set.kept_groups()),
      geometry_(base ? set.base_geometry_ranges() : set.geometry_ranges() - first_geometry_),
      normals_(!base && set.sps_normal_bits > 0 ? 1 : 0),
      coefficients_(std::size_t{groups_} * kept_ranges(set, base)) {
  std::size_t next = geometry_ + normals_ + coefficients_;
  for (std::uint32_t layer = 1; layer < set.kept_layers() && coefficients_ > 0; ++layer) {
    Layer& of_groups = layers_.emplace_back(Layer{next, {}});
    for (std::uint32_t g = 0; g < groups_; ++g)
      if (set.layers_of(g) > layer) of_groups.groups.push_back(g);
    next += coefficients_ / groups_ * of_groups.groups.size();
  }
  size_ = next;
}

/// Of coefficients: those that begin above what a cut left.
std::uint32_t PartList::kept_ranges(const SequenceParameterSet& set, bool base) {
  const std::uint32_t of_base = set.base_coefficient_ranges();
  std::uint32_t kept = 0;
  for (std::uint32_t r = 0; r < set.coefficient_ranges(); ++r)
    if ((r < of_base) == base &&
        !(set.sps_cut_flag && set.coefficient_begin(r) >= set.sps_cut_levels))
      ++kept;
  return kept;
}

UnitType PartList::type_at(std::size_t place) const {
  if (place < geometry_) return UnitType::kGeometry;
  if (place < geometry_ + normals_) return UnitType::kNormals;
  if (place < geometry_ + normals_ + coefficients_) return UnitType::kCoefficients;
  return place < size() ? UnitType::kRefinement : UnitType::kDigest;
}

std::size_t PartList::place_of(const PartUnit& unit) const {
  const SliceUnitHeader& h = unit.header;
  if (unit.type == UnitType::kGeometry) return h.range - first_geometry_;
  if (unit.type == UnitType::kNormals) return normals_ > 0 ? geometry_ : size() + 1;
  if (unit.type == UnitType::kDigest) return size();
  if (coefficients_ == 0 || h.group >= groups_) return size() + 1;
  if ((h.range - first_coefficients_) * std::size_t{groups_} >= coefficients_) return size() + 1;
  if (unit.type == UnitType::kRefinement) return place_of_refinement(h);
  return geometry_ + normals_ + std::size_t{h.range - first_coefficients_} * groups_ + h.group;
}

std::size_t PartList::place_of_refinement(const SliceUnitHeader& h) const {
  if (h.layer > layers_.size()) return size() + 1;
  const Layer& layer = layers_[h.layer - 1];
  const auto group = std::find(layer.groups.begin(), layer.groups.end(), h.group);
  if (group == layer.groups.end()) return size() + 1;
  return layer.first + std::size_t{h.range - first_coefficients_} * layer.groups.size() +
         static_cast<std::size_t>(group - layer.groups.begin());
}

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
  return collector.take();
}

}  // namespace slf
