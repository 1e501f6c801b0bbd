// SPDX-License-Identifier: Apache-2.0
#include "codec/decoder/base_decoder.h"

#include <algorithm>

#include "base/multiversion.h"
#include "codec/decoder/component_decoder.h"
#include "codec/decoder/decode_cost.h"
#include "codec/decoder/node_voxels.h"
#include "geometry/cell_box.h"
#include "geometry/morton.h"
#include "geometry/octree_decoder.h"
#include "geometry/weight_classes.h"

namespace slf {
namespace {

/// Codes of the base on the grid's axes, so that splits and levels are those of the whole tree.
std::vector<std::uint64_t> grid_codes(const BaseState& base, const StreamHeader& stream) {
  std::vector<std::uint64_t> codes = base.cells;
  for (auto& code : codes) code <<= stream.lowest_split(base.level);
  return codes;
}

/// The values of the rows that join nodes of `level`.
Result<BaseValues> decode_level_components(const PartUnits& units, const Request& request,
                                           const BaseState& base, int level, int threads,
                                           bool means) {
  const auto codes = grid_codes(base, request.stream);
  const RahtTop top = build_raht_top(codes, request.stream.lowest_split(level), base.weights());
  SLF_CHECK(check_values(request, top.tree.size()));
  const ComponentRows rows{
      codes,         top.tree, top.first, 0, std::min(request.levels, request.stream.base_levels()),
      base.weights()};
  std::vector<std::int32_t> components(top.tree.size() * request.planes());
  ValueState state = start_values(request, rows);
  const auto step = [&](const PartUnit& unit, std::size_t) {
    return decode_values_unit(unit, request, rows, state, components);
  };
  SLF_CHECK(for_each_wanted(units, Owner::kBase, request, has_values, step));
  BaseValues left{{}, state.models.all_states(), {}, state.coded.any, state.coded.last};
  SLF_CHECK(reconstruct(request, rows, std::move(state.coded), components, threads));
  if (means) to_means(rows, request.planes(), components);
  left.values = std::move(components);
  left.models = std::move(state.models);
  return left;
}

/// 8.4: one unit; the last has the weights of the cells, where there are functions.
Result<Done> decode_geometry_unit(const PartUnit& unit, const StreamHeader& stream,
                                  OctreeDecoder& octree, BaseState& base) {
  const int end = static_cast<int>(stream.set.geometry_end(unit.header.range));
  if (end < stream.base_levels() || stream.set.sps_num_functions == 0)
    return in_unit(unit, octree.decode(unit.payload, end));
  SLF_TRY(const auto classes, in_unit(unit, octree.decode_with_classes(unit.payload, end)));
  base.weight_before = weights_before(classes);
  return Done{};
}

std::vector<std::uint32_t> first_cells(const SliceTable& table) {
  std::vector<std::uint32_t> first;
  std::uint32_t next = 0;
  for (const SliceEntry& slice : table.slices) {
    first.push_back(next);
    next += static_cast<std::uint32_t>(slice.cells());
  }
  return first;
}

}  // namespace

SLF_OWN_CALL
Result<BaseState> decode_base_geometry(const PartUnits& units, const Request& request) {
  const StreamHeader& stream = request.stream;
  BaseState base{{0}, first_cells(stream.table), OccupancyStates(stream.table.num_points())};
  if (!stream.has_base()) return base;
  OctreeDecoder octree(stream.base_levels(), stream.num_cells(), std::move(base.octree));
  const PartUnit* last = nullptr;
  const auto step = [&](const PartUnit& unit, std::size_t) {
    last = &unit;
    return decode_geometry_unit(unit, stream, octree, base);
  };
  SLF_CHECK(for_each_wanted(units, Owner::kBase, request, has_occupancy, step));
  base.level = octree.level();
  base.octree = octree.take_states();
  base.cells = octree.take_morton();
  if (base.level == 0) base.cells.clear();  // 8.9.2: nothing is known without a geometry unit
  if (base.is_known(stream) && base.cells.size() != stream.num_cells())
    return in_unit(*last, Error{Errc::kOutOfRange, "gu_occupancy"});
  return base;
}

Result<Done> check_boxes(const Units& units, const StreamHeader& stream, const BaseState& base) {
  const Unit* unit = units.first(UnitType::kIndex);
  if (unit == nullptr || !stream.has_base() || !base.is_known(stream)) return Done{};
  SLF_TRY(const Index index, read_index(*unit, stream.set));
  for (std::size_t s = 0; s < index.boxes.size(); ++s)
    if (box_of_cells(base.cells_of(stream.table, s)) != index.boxes[s])
      return in_unit(*unit, Error{Errc::kOutOfRange, "index_box"});
  return Done{};
}

std::vector<std::uint8_t> choose_slices_by_cell(const Request& request, const BaseState& base) {
  return choose_slices(request, [&](std::size_t s) {
    const auto cells = base.cells_of(request.stream.table, s);
    return std::any_of(cells.begin(), cells.end(), [&](std::uint64_t code) {
      const Voxel cell = from_morton(code);
      return request.meets_region(cell, cell, base.level);
    });
  });
}

Result<BaseValues> decode_base_components(const PartUnits& units, const Request& request,
                                          const BaseState& base) {
  if (!request.stream.has_base() || request.planes() == 0) return BaseValues{};
  const bool apart = request.stream.apart();
  SLF_TRY(BaseValues left,
          decode_level_components(units, request, base, request.stream.base_levels(), 1, apart));
  if (apart) return BaseValues{{}, {}, std::move(left.values), {}, nullptr};
  return left;
}

Result<Done> give_out_base(const PartUnits& units, const Request& request, int threads,
                           const BaseState& base, LightField& field) {
  if (base.is_known(request.stream) && request.planes() > 0) {
    SLF_TRY(BaseValues given,
            decode_level_components(units, request, base, request.levels, threads, true));
    field.components = std::move(given.values);
  }
  field.positions = node_voxels(base.cells, base.level, request);
  SLF_CHECK(check_values(request, field.num_points()));
  field.components.resize(field.num_points() * request.planes());
  field.normals.octahedral.resize(field.normals.bits > 0 ? field.num_points() : 0);
  return Done{};
}

}  // namespace slf
