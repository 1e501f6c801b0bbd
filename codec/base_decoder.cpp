#include "codec/base_decoder.h"

#include <algorithm>

#include "base/multiversion.h"
#include "codec/decode_cost.h"
#include "codec/node_voxels.h"
#include "geometry/cell_box.h"
#include "geometry/octree_decoder.h"
#include "geometry/weight_classes.h"

namespace slf {
namespace {

/// Codes of the base in the grid's frame, so that splits and levels are those of the whole tree.
std::vector<std::uint64_t> grid_codes(const Base& base, const SequencePlan& plan) {
  std::vector<std::uint64_t> codes = base.cells;
  for (auto& code : codes) code <<= plan.lowest_split(base.level);
  return codes;
}

/// Components of the rows of `top`; what slices need of them stays in base.components.
Result<Done> decode_components(const PartUnits& units, const SequencePlan& plan,
                               const std::vector<std::uint64_t>& codes, const RahtTop& top,
                               int threads, bool means, Base& base) {
  SLF_CHECK(check_level(plan, top.tree.size()));
  ComponentDecoder decoder(plan, {codes, top.tree, top.first, 0,
                                  std::min(plan.levels, plan.base_levels()), base.weights()});
  std::vector<std::int32_t> components(top.tree.size() * plan.planes());
  for (const PartUnit& unit : units)
    if (plan.wants_values(unit.type, unit.header)) {
      SLF_CHECK(plan.begin_unit(unit.payload.size()));
      SLF_CHECK(decoder.decode(unit, components));
    }
  SLF_CHECK(decoder.reconstruct(components, threads));
  if (means) decoder.to_means(components);
  base.components = decoder.take_base(std::move(components));
  return Done{};
}

/// 8.4: one unit; the last has the weights of the cells, where there are functions.
Result<Done> decode_geometry_unit(const PartUnit& unit, const SequencePlan& plan,
                                  OctreeDecoder& octree, Base& base) {
  const int end = static_cast<int>(plan.set.geometry_end(unit.header.range));
  if (end < plan.base_levels() || plan.set.sps_num_functions == 0)
    return in_unit(unit, octree.decode(unit.payload, end));
  SLF_TRY(const auto classes, in_unit(unit, octree.decode_with_classes(unit.payload, end)));
  base.weight_before = weights_before(classes);
  return Done{};
}

}  // namespace

SLF_OWN_CALL
Result<Base> decode_base_geometry(const PartUnits& units, const SequencePlan& plan) {
  Base base{{0}, 0, OccupancyStates(plan.table.num_points()), {}, {}, {}, true};
  const std::uint64_t cells = plan.table.num_cells();
  const PartUnit* last = nullptr;
  std::uint32_t next = 0;
  for (const SliceEntry& slice : plan.table.slices) {
    base.first.push_back(next);
    next += static_cast<std::uint32_t>(slice.cells());
  }
  if (!plan.has_base()) return base;
  OctreeDecoder octree(plan.base_levels(), cells, std::move(base.states));
  for (const PartUnit& unit : units) {
    if (unit.type != UnitType::kGeometry) continue;
    if (!plan.needs_points() && octree.level() >= plan.levels) break;
    SLF_CHECK(plan.begin_unit(unit.payload.size()));
    SLF_CHECK(decode_geometry_unit(unit, plan, octree, base));
    last = &unit;
  }
  base.level = octree.level();
  base.states = octree.take_states();
  base.cells = octree.take_morton();
  if (base.level == 0) base.cells.clear();  // 8.9.2: nothing is known without a geometry unit
  base.whole = base.is_known(plan) || (!plan.needs_points() && base.level >= plan.levels);
  if (base.is_known(plan) && base.cells.size() != cells)
    return in_unit(*last, Error{Errc::kOutOfRange, "gu_occupancy"});
  return base;
}

Result<Done> check_boxes(const std::vector<CellBox>& boxes, const SequencePlan& plan,
                         const Base& base) {
  for (std::size_t s = 0; s < boxes.size(); ++s)
    if (box_of_cells(base.cells_of(plan.table, s)) != boxes[s])
      return Error{Errc::kOutOfRange, "index_box"};
  return Done{};
}

Result<Done> decode_base_components(const PartUnits& units, const SequencePlan& plan, Base& base) {
  if (!plan.has_base() || plan.planes() == 0) return Done{};
  const auto codes = grid_codes(base, plan);
  const RahtTop top = build_raht_top(codes, plan.lowest_split(plan.base_levels()), base.weights());
  SLF_CHECK(decode_components(units, plan, codes, top, 1, plan.table.apart(), base));
  if (plan.table.apart()) base.components = {{}, {}, std::move(base.components.values), {}, {}};
  return Done{};
}

Result<Done> give_out_base(const PartUnits& units, const SequencePlan& plan, int threads,
                           Base& base, LightField& field) {
  const auto codes = grid_codes(base, plan);
  if (base.is_known(plan) && plan.planes() > 0) {
    const RahtTop top = build_raht_top(codes, plan.lowest_split(plan.levels), base.weights());
    SLF_CHECK(decode_components(units, plan, codes, top, threads, true, base));
    field.components = std::move(base.components.values);
  }
  field.positions = node_voxels(base.cells, base.level, plan);
  SLF_CHECK(check_level(plan, field.num_points()));
  field.components.resize(field.num_points() * plan.planes());
  field.normals.octahedral.resize(field.normals.bits > 0 ? field.num_points() : 0);
  return Done{};
}

}  // namespace slf
