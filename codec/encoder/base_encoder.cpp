// SPDX-License-Identifier: Apache-2.0
#include "codec/encoder/base_encoder.h"

#include <numeric>

#include "attributes/encoder/raht_forward.h"
#include "codec/encoder/component_encoder.h"
#include "geometry/encoder/octree_encoder.h"

namespace slf {

Result<EncodedBase, InputError> encode_base_geometry(const SliceCoding& coding,
                                                     const SceneLayout& layout) {
  EncodedBase base{OccupancyStates(layout.table.num_points()), {}, {}, {}, {}, {}};
  if (layout.base_levels == 0) return base;
  OctreeEncoder octree(layout.cells, layout.base_levels, base.geometry);
  const UnitLayout units = layout_of(coding.set);
  for (const UnitSlot& slot : slots_of(units, Owner::kBase)) {
    if (slot.type != UnitType::kGeometry) continue;
    const int end = static_cast<int>(coding.set.geometry_end(slot.range));
    const auto body = end < layout.base_levels || coding.set.sps_num_functions == 0
                          ? octree.encode(end)
                          : octree.encode(end, layout.classes);
    SLF_TRY(CodedUnit unit,
            part_unit(slot.type, ids_of(slot, SliceUnitHeader::kBase), body, coding.set));
    base.units.push_back(std::move(unit));
  }
  base.geometry = octree.states();
  return base;
}

Result<Done, InputError> encode_base_components(const SliceCoding& coding,
                                                const SceneLayout& layout,
                                                std::vector<std::int32_t> input, int threads,
                                                EncodedBase& base) {
  if (layout.base_levels == 0 || coding.planes() == 0) return Done{};
  const SequenceParameterSet& set = coding.set;
  const int dropped = coding.grid_bits() - layout.base_levels;
  std::vector<std::uint64_t> codes = layout.cells;
  for (auto& code : codes) code <<= 3 * dropped;
  const RahtTree tree = build_raht_tree(codes, layout.weights());
  raht_forward(tree, static_cast<int>(coding.planes()), input, threads);
  base.coefficients = std::move(input);
  QuantiserInput rows = coding.quantiser_input(tree, codes);
  rows.dropped = dropped;
  rows.weights = layout.weights();
  base.quantised = quantise_coefficients(rows, base.coefficients, threads);
  std::vector<std::uint32_t> first(tree.size() + 1);
  std::iota(first.begin(), first.end(), 0u);
  CoefficientModels& models = base.models.emplace_back(
      coding.groups, tree, codes, first, set.has_vectors(), layout.weights(), set.num_layers());
  ComponentEncoder encoder(coding, tree, 0, base.quantised, base.coefficients, models);
  const UnitLayout units = layout_of(set);
  for (const UnitSlot& slot : slots_of(units, Owner::kBase))
    if (has_values(slot.type)) {
      SLF_TRY(CodedUnit unit, encoder.encode(ids_of(slot, SliceUnitHeader::kBase)));
      base.units.push_back(std::move(unit));
    }
  base.states = models.all_states();
  return Done{};
}

}  // namespace slf
