// SPDX-License-Identifier: Apache-2.0
// Headers alone: what `slf info` shows. Spec 7.
#include "bitstream/index.h"
#include "codec/scene_units.h"
#include "codec/sequence.h"
#include "codec/transform_units.h"
#include "slf/decoder.h"

namespace slf {
namespace {

Result<UnitInfo> describe(const Unit& unit, const SequenceParameterSet& set) {
  UnitInfo info;
  info.type = unit_name(unit.type);
  info.offset = unit.offset;
  info.bytes = unit.bytes;
  if (!has_ids(unit.type)) return info;
  SLF_TRY(const PartUnit read, read_part_unit(unit, set));
  const SliceUnitHeader& h = read.header;
  info.base = h.of_base();
  if (!info.base) info.slice = static_cast<int>(h.slice_id);
  if (unit.type == UnitType::kGeometry) {
    info.level_first = static_cast<int>(set.geometry_begin(h.range));
    info.level_last = static_cast<int>(set.geometry_end(h.range)) - 1;
  } else if (has_values(unit.type)) {
    info.level_first = static_cast<int>(set.coefficient_begin(h.range));
    info.level_last = static_cast<int>(set.coefficient_end(h.range)) - 1;
    info.group = static_cast<int>(h.group);
    info.layer = static_cast<int>(h.layer);
  }
  info.prediction.assign(h.cu_prediction.begin(), h.cu_prediction.end());
  return info;
}

/// Voxels of the cells of a box.
VoxelBox box_of(const CellBox& cells, const SequenceParameterSet& set) {
  const std::uint32_t below = set.grid_bits() - set.sps_base_levels;
  VoxelBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = static_cast<std::int32_t>(cells[axis] << below);
    box.high[axis] = static_cast<std::int32_t>(((cells[axis + 3] + 1) << below) - 1);
  }
  return box;
}

/// The base, the slices and what was cut off. Bytes of slices are added where units are read.
Result<Done> describe_scene(const Units& units, const SequenceParameterSet& set,
                            const SliceTable& table, StreamInfo& info) {
  info.base_levels = static_cast<int>(set.sps_base_levels);
  if (table.slices_num_minus1 > 0) info.slice_start = static_cast<SliceStart>(table.slices_start);
  info.num_slices = table.slices.size();
  info.num_points = table.num_points();
  SLF_TRY(const auto index, find_index(units, set));
  for (std::size_t s = 0; s < table.slices.size(); ++s) {
    info.slices.push_back({table.slices[s].cells(), table.slices[s].points(), 0, {}});
    if (index && s < index->boxes.size()) info.slices[s].box = box_of(index->boxes[s], set);
  }
  if (set.sps_cut_flag)
    info.cut = CutInfo{static_cast<int>(set.sps_cut_levels), static_cast<int>(set.sps_cut_groups),
                       static_cast<int>(set.sps_cut_layers), set.sps_cut_slices_flag != 0};
  return Done{};
}

}  // namespace

Result<StreamInfo> read_info(std::span<const std::uint8_t> stream, const DecodeLimits& limits) {
  SLF_TRY(const OpenStream opened, open_stream(stream, limits));
  const auto& [units, scene] = opened;
  const SequenceParameterSet& set = scene.stream.set;
  StreamInfo info;
  info.version_major = units.version_major;
  info.version_minor = units.version_minor;
  info.profile = static_cast<int>(set.sps_profile);
  info.level = static_cast<int>(set.sps_level);
  info.header = header_of(set);
  SLF_CHECK(describe_scene(units, set, scene.stream.table, info));
  info.num_groups = static_cast<int>(set.num_groups());
  info.group = function_groups(set);
  info.step = function_steps(set);
  const PlaneGroups groups = plane_groups(set);
  SLF_TRY(auto transforms, collect_transforms(units, groups));
  SLF_CHECK(read_matrices(units, set, groups, groups.size(), transforms));
  for (const PlaneTransform& t : transforms)
    info.transforms.push_back({static_cast<int>(t.first_group),
                               static_cast<int>(t.first_group + t.num_groups - 1),
                               static_cast<int>(t.functions.size()), static_cast<int>(t.rank),
                               t.lanes == 1, t.colour != PlaneTransform::kNoColour});
  info.geometry_coder = set.has_draco() ? "draco" : "octree";
  info.coefficient_coder =
      std::array{"vector", "independent", "texture", "vector"}[set.sps_coefficient_coder];
  for (std::uint32_t g = 0; g < set.num_groups(); ++g)
    info.layers.push_back(static_cast<int>(set.layers_of(g)));
  if (set.has_texture()) info.texture_bits = set.texture_bits();
  info.prediction = set.sps_prediction_flag != 0;
  SLF_TRY(info.metadata, collect_metadata(units));
  info.normal_bits = static_cast<int>(set.sps_normal_bits);
  info.units.reserve(units.units.size());
  for (const Unit& unit : units.units) {
    SLF_TRY(UnitInfo described, describe(unit, set));
    if (described.slice >= 0) info.slices[std::size_t(described.slice)].bytes += described.bytes;
    info.units.push_back(std::move(described));
  }
  info.complete = units.complete;
  return info;
}

}  // namespace slf
