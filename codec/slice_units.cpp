#include "codec/slice_units.h"

#include "geometry/morton.h"

namespace slf {
namespace {

/// The order of 7.1 within a slice: geometry, normals, coefficients, digest.
int place_of(UnitType type) {
  switch (type) {
    case UnitType::kGeometry:
      return 0;
    case UnitType::kNormals:
      return 1;
    case UnitType::kCoefficients:
      return 2;
    default:
      return 3;
  }
}

/// Level ranges and groups are checked where they are decoded.
bool follows(const std::vector<SliceUnit>& before, const SliceUnit& unit,
             const SequenceParameterSet& set) {
  if (unit.type == UnitType::kNormals && set.sps_normal_bits == 0) return false;
  if (unit.type == UnitType::kCoefficients && set.sps_num_functions == 0) return false;
  if (before.empty()) return true;
  const bool may_repeat = unit.type == UnitType::kCoefficients ||
                          (unit.type == UnitType::kGeometry && set.sps_geometry_coder == 0);
  const int place = place_of(unit.type), last = place_of(before.back().type);
  return place > last || (place == last && may_repeat);
}

}  // namespace

Result<SequenceParameterSet> find_sequence(const Units& units) {
  if (units.units.empty()) return Error{Errc::kTruncated, "sequence_unit", 64};
  if (units.units.front().type != UnitType::kSequence)
    return Error{Errc::kOutOfRange, "unit_type", units.units.front().offset * 8};
  for (std::size_t i = 1; i < units.units.size(); ++i)
    if (units.units[i].type == UnitType::kSequence)
      return Error{Errc::kOutOfRange, "unit_type", units.units[i].offset * 8};
  return parse_sequence_parameter_set(units.units.front().payload);
}

Result<SliceUnit> read_slice_unit(const Unit& unit, const SequenceParameterSet& set) {
  BitReader in(unit.payload);
  ParseSyntax parse{in};
  SliceUnit read{unit.type, {}, {}, unit.offset};
  slice_unit_header(parse, read.header,
                    unit.type == UnitType::kGeometry || unit.type == UnitType::kCoefficients,
                    unit.type == UnitType::kCoefficients, set);
  read.payload = in.align_and_rest("alignment_zero_bits");
  if (!in.ok()) return in.error();
  return read;
}

Result<std::vector<SliceDecoder>> collect_slices(const Units& units,
                                                 const SequenceParameterSet& set) {
  std::vector<SliceDecoder> slices;
  std::uint64_t free_from = 0;  // first Morton code of the grid that no slice has claimed
  for (const Unit& unit : units.units) {
    const Error here{Errc::kOutOfRange, "slice_id", unit.offset * 8};
    if (unit.type == UnitType::kSlice) {
      SLF_TRY(const SliceHeader header, parse_slice_header(unit.payload, set.grid_bits()));
      if (header.slice_id != slices.size()) return here;
      const auto& cell = header.slice_cell;
      const std::uint64_t code =
          morton({static_cast<std::int32_t>(cell[0]), static_cast<std::int32_t>(cell[1]),
                  static_cast<std::int32_t>(cell[2])});
      const std::uint64_t first = code << (3 * header.slice_depth);
      if (first < free_from) return Error{Errc::kOutOfRange, "slice_cell", unit.offset * 8};
      free_from = first + (std::uint64_t{1} << (3 * header.slice_depth));
      slices.emplace_back();
      slices.back().header = header;
    } else if (unit.type == UnitType::kGeometry || unit.type == UnitType::kNormals ||
               unit.type == UnitType::kCoefficients || unit.type == UnitType::kDigest) {
      SLF_TRY(SliceUnit read, read_slice_unit(unit, set));
      if (slices.empty() || read.header.slice_id != slices.size() - 1) return here;
      if (!follows(slices.back().units, read, set))
        return Error{Errc::kOutOfRange, "unit_type", unit.offset * 8};
      slices.back().units.push_back(read);
    }
  }
  return slices;
}

}  // namespace slf
