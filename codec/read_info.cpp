// Headers alone: what `slf info` shows. Spec 7.
#include "bitstream/index.h"
#include "bitstream/metadata.h"
#include "codec/sequence.h"
#include "codec/slice_units.h"
#include "codec/transform_units.h"
#include "slf/decoder.h"

namespace slf {
namespace {

/// Levels of the grid that range `range` covers, first and last.
void set_levels(UnitInfo& info, const std::vector<std::uint32_t>& ends, std::uint32_t range,
                std::uint32_t bits) {
  info.level_first = range == 0 ? 0 : static_cast<int>(range_end(ends, range - 1, bits));
  info.level_last = static_cast<int>(range_end(ends, range, bits)) - 1;
}

Result<UnitInfo> describe(const Unit& unit, const SequenceParameterSet& set) {
  UnitInfo info;
  info.type = unit_name(unit.type);
  info.offset = unit.offset;
  info.bytes = unit.bytes;
  const bool geometry = unit.type == UnitType::kGeometry,
             coefficients = unit.type == UnitType::kCoefficients;
  if (geometry || coefficients || unit.type == UnitType::kNormals ||
      unit.type == UnitType::kDigest) {
    SLF_TRY(const SliceUnit read, read_slice_unit(unit, set));
    info.slice = static_cast<int>(read.header.slice_id);
    if (geometry) set_levels(info, set.sps_geometry_range_end, read.header.range, set.grid_bits());
    if (coefficients)
      set_levels(info, set.sps_coefficient_range_end, read.header.range, set.grid_bits());
    if (coefficients) info.group = static_cast<int>(read.header.group);
    info.prediction.assign(read.header.cu_prediction.begin(), read.header.cu_prediction.end());
  } else if (unit.type == UnitType::kSlice) {
    SLF_TRY(const SliceHeader header, parse_slice_header(unit.payload, set.grid_bits()));
    info.slice = static_cast<int>(header.slice_id);
  }
  return info;
}

}  // namespace

Result<StreamInfo> read_info(std::span<const std::uint8_t> stream, const DecodeLimits& limits) {
  if (stream.size() > limits.max_stream_bytes) return Error{Errc::kLimitExceeded, "stream", 0};
  SLF_TRY(const Units units, split_units(stream));
  SLF_TRY(const SequenceParameterSet set, find_sequence(units));
  SLF_CHECK(check_index(units));
  SLF_TRY(const auto slices, collect_slices(units, set));
  StreamInfo info;
  info.version_major = static_cast<int>(set.sps_version_major);
  info.version_minor = static_cast<int>(set.sps_version_minor);
  info.profile = static_cast<int>(set.sps_profile);
  info.level = static_cast<int>(set.sps_level);
  info.header = header_of(set);
  info.num_slices = slices.size();
  for (const SliceDecoder& slice : slices)
    info.num_points += std::uint64_t{slice.header.slice_num_points_minus1} + 1;
  info.num_groups = static_cast<int>(set.num_groups());
  info.group = function_groups(set);
  info.step = function_steps(set);
  SLF_TRY(const auto transforms, collect_transforms(units, set, plane_groups(set)));
  for (const PlaneTransform& t : transforms)
    info.transforms.push_back({static_cast<int>(t.first_group),
                               static_cast<int>(t.first_group + t.num_groups - 1),
                               static_cast<int>(t.functions.size()), static_cast<int>(t.rank),
                               t.lanes == 1, t.colour != PlaneTransform::kNoColour});
  info.geometry_coder = set.sps_geometry_coder == 0 ? "octree" : "draco";
  info.coefficient_coder =
      std::array{"vector", "independent", "texture"}[set.sps_coefficient_coder];
  if (set.has_texture()) info.texture_bits = set.texture_bits();
  bool has_metadata = false;
  for (const Unit& unit : units.units) {
    SLF_TRY(UnitInfo described, describe(unit, set));
    info.units.push_back(std::move(described));
    if (unit.type != UnitType::kMetadata) continue;
    if (has_metadata) return Error{Errc::kOutOfRange, "unit_type", unit.offset * 8};
    has_metadata = true;
    SLF_TRY(const Metadata metadata, parse_metadata(unit.payload));
    info.metadata.insert(info.metadata.end(), metadata.begin(), metadata.end());
  }
  info.complete = units.complete;
  return info;
}

}  // namespace slf
