// SPDX-License-Identifier: Apache-2.0
#include "codec/transform_units.h"

#include <algorithm>

#include "base/error_place.h"
#include "bitstream/transform_header.h"
#include "codec/scene_units.h"
#include "entropy/range_decoder.h"

namespace slf {
namespace {

Result<Done> parse_columns(std::span<const std::uint8_t> codeword, ColumnRange columns,
                           PlaneTransform& t) {
  RangeDecoder decoder(codeword);
  if (!code_columns(decoder, t, columns, {})) return decoder.here(Errc::kOutOfRange, "cu_matrix");
  return decoder.finish("cu_matrix");
}

/// Where an element stands that was read.
std::uint64_t bit_of(std::string_view element, const SyntaxLog& log) {
  for (const SyntaxEntry& entry : log)
    if (entry.element == element) return entry.bit;
  return 0;
}

Result<PlaneTransform> parse_transform(const Unit& unit, const PlaneGroups& groups) {
  BitReader in(unit.payload);
  SyntaxLog log;
  ParseSyntax parse{in, &log};
  TransformHeader header;
  transform_header(parse, header, static_cast<std::uint32_t>(groups.size()));
  in.trailing_bits("tr_trailing_bits");
  if (!in.ok()) return in_unit(unit, in.error());
  PlaneTransform t;
  t.first_group = header.tr_first_group;
  t.num_groups = std::size_t{header.tr_num_groups_minus1} + 1;
  t.functions = functions_of_groups(groups, t.first_group, t.num_groups);
  t.rank = std::size_t{header.tr_rank_minus1} + 1;
  t.lanes = header.tr_joint_flag ? 1 : 3;
  t.colour = header.tr_colour;
  if (t.rank > t.functions.size() || t.rows() * t.columns() > PlaneTransform::kMaxEntries)
    return in_unit(unit, Error{Errc::kOutOfRange, "tr_rank_minus1", bit_of("tr_rank_minus1", log)});
  t.matrix.resize(t.rows() * t.columns());
  return t;
}

/// The columns that a coefficient unit brings. Those of units that are missing stay 0.
Result<Done> read_columns(const PartUnit& unit, const PlaneGroups& groups,
                          std::vector<PlaneTransform>& transforms) {
  for (PlaneTransform& t : transforms) {
    const ColumnRange columns = columns_of_group(t, groups, unit.header.group);
    if (!columns.empty()) return parse_columns(unit.matrix, columns, t);
  }
  if (!unit.matrix.empty()) return Error{Errc::kOutOfRange, "cu_matrix_bytes"};
  return Done{};
}

}  // namespace

std::vector<std::uint16_t> functions_of_groups(const PlaneGroups& groups, std::size_t first,
                                               std::size_t count) {
  std::vector<std::uint16_t> functions;
  for (std::size_t g = first; g < first + count; ++g)
    functions.insert(functions.end(), groups[g].begin(), groups[g].end());
  return functions;
}

ColumnRange columns_of_group(const PlaneTransform& t, const PlaneGroups& groups,
                             std::size_t group) {
  if (group < t.first_group || group >= t.first_group + t.num_groups) return {};
  std::size_t before = 0;
  for (std::size_t g = t.first_group; g < group; ++g) before += groups[g].size();
  const std::size_t begin = std::min(before, t.rank);
  const std::size_t end = std::min(before + groups[group].size(), t.rank);
  return {begin * 3 / t.lanes, end * 3 / t.lanes};
}

Result<Done> read_matrices(const Units& units, const SequenceParameterSet& set,
                           const PlaneGroups& groups, std::size_t kept,
                           std::vector<PlaneTransform>& transforms) {
  if (transforms.empty()) return Done{};
  for (const Unit& unit : units.units) {
    if (unit.type != UnitType::kCoefficients) continue;
    SLF_TRY(const PartUnit part, read_part_unit(unit, set));
    if (part.header.range != 0 || part.header.group >= kept) continue;
    const std::uint64_t header_bytes =
        unit.payload.size() - part.payload.size() - part.matrix.size();
    SLF_CHECK(
        in_unit(unit, counted_from(8 * header_bytes, read_columns(part, groups, transforms))));
  }
  return Done{};
}

Result<std::vector<PlaneTransform>> collect_transforms(const Units& units,
                                                       const PlaneGroups& groups) {
  std::vector<PlaneTransform> transforms;
  for (const Unit& unit : units.units) {
    if (unit.type != UnitType::kTransform) continue;
    SLF_TRY(PlaneTransform transform, parse_transform(unit, groups));
    if (!transforms.empty() &&
        transform.first_group < transforms.back().first_group + transforms.back().num_groups)
      return in_unit(unit, Error{Errc::kOutOfRange, "tr_first_group"});
    transforms.push_back(std::move(transform));
  }
  return transforms;
}

CodedFunctions code_functions(PlaneGroups groups, std::vector<PlaneTransform>& transforms) {
  CodedFunctions coded;
  std::vector<std::vector<std::uint16_t>> standing;  // by transform: functions
  for (const PlaneTransform& t : transforms) {
    std::size_t left = t.rank;
    auto& here = standing.emplace_back();
    for (std::size_t g = t.first_group; g < t.first_group + t.num_groups && g < groups.size();
         ++g) {
      groups[g].resize(std::min(groups[g].size(), left));
      left -= groups[g].size();
      here.insert(here.end(), groups[g].begin(), groups[g].end());
    }
  }
  std::vector<std::uint8_t> is_coded;
  for (const auto& functions : groups)
    for (const std::uint16_t k : functions) {
      if (is_coded.size() <= k) is_coded.resize(std::size_t{k} + 1);
      is_coded[k] = true;
    }
  for (std::size_t k = 0; k < is_coded.size(); ++k)
    if (is_coded[k]) coded.functions.push_back(static_cast<std::uint16_t>(k));
  const auto to_places = [&](std::vector<std::uint16_t>& functions) {
    for (std::uint16_t& k : functions)
      k = static_cast<std::uint16_t>(
          std::lower_bound(coded.functions.begin(), coded.functions.end(), k) -
          coded.functions.begin());
  };
  for (auto& functions : groups) to_places(functions);
  for (std::size_t i = 0; i < transforms.size(); ++i) {
    to_places(standing[i]);
    transforms[i].components = std::move(standing[i]);
  }
  coded.groups = std::move(groups);
  return coded;
}

}  // namespace slf
