#include "codec/transform_units.h"

#include <algorithm>

#include "entropy/range_decoder.h"

namespace slf {
namespace {

Result<PlaneTransform> parse_transform(const Unit& unit, const PlaneGroups& groups) {
  BitReader in(unit.payload);
  ParseSyntax parse{in};
  TransformHeader header;
  transform_header(parse, header, static_cast<std::uint32_t>(groups.size()));
  const auto codeword = in.align_and_rest("alignment_zero_bits");
  if (!in.ok()) return in.error();
  PlaneTransform t;
  t.first_group = header.tr_first_group;
  t.num_groups = std::size_t{header.tr_num_groups_minus1} + 1;
  t.functions = functions_of_groups(groups, t.first_group, t.num_groups);
  t.rank = std::size_t{header.tr_rank_minus1} + 1;
  t.lanes = header.tr_joint_flag ? 1 : 3;
  t.colour = header.tr_colour;
  if (t.rank > t.functions.size() || t.rows() * t.columns() > PlaneTransform::kMaxEntries)
    return Error{Errc::kOutOfRange, "tr_rank_minus1", unit.offset * 8};
  RangeDecoder decoder(codeword);
  if (!code_matrix(decoder, t, {})) return Error{Errc::kOutOfRange, "tr_matrix", unit.offset * 8};
  SLF_CHECK(decoder.finish("tr_matrix"));
  return t;
}

}  // namespace

std::vector<std::uint16_t> functions_of_groups(const PlaneGroups& groups, std::size_t first,
                                               std::size_t count) {
  std::vector<std::uint16_t> functions;
  for (std::size_t g = first; g < first + count; ++g)
    functions.insert(functions.end(), groups[g].begin(), groups[g].end());
  return functions;
}

Result<std::vector<PlaneTransform>> collect_transforms(const Units& units,
                                                       const SequenceParameterSet& set,
                                                       const PlaneGroups& groups) {
  std::vector<PlaneTransform> transforms;
  bool in_slices = false;
  for (const Unit& unit : units.units) {
    in_slices = in_slices || unit.type == UnitType::kSlices;
    if (in_slices && transforms.size() < set.num_transforms())
      return Error{Errc::kOutOfRange, "sps_num_transforms_minus1", unit.offset * 8};
    if (unit.type != UnitType::kTransform) continue;
    if (in_slices || transforms.size() == set.num_transforms())
      return Error{Errc::kOutOfRange, "unit_type", unit.offset * 8};
    SLF_TRY(PlaneTransform transform, parse_transform(unit, groups));
    if (!transforms.empty() &&
        transform.first_group < transforms.back().first_group + transforms.back().num_groups)
      return Error{Errc::kOutOfRange, "tr_first_group", unit.offset * 8};
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
  for (const auto& functions : groups)
    coded.functions.insert(coded.functions.end(), functions.begin(), functions.end());
  std::sort(coded.functions.begin(), coded.functions.end());
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
