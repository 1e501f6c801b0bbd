// SPDX-License-Identifier: Apache-2.0
#include "codec/decoder/decoder_state.h"

#include <utility>

#include "attributes/level_prediction.h"

namespace slf {

OccupancyStates start_octree(const SliceToDecode& slice, bool alone) {
  if (slice.stream().apart()) return OccupancyStates(slice.points());
  if (slice.follows()) return OccupancyStates(0);
  if (slice.leads() || alone) return std::move(slice.scene.base.octree);
  return slice.scene.base.octree;
}

ValueState start_values(const Request& request, const ComponentRows& rows) {
  const SequenceParameterSet& set = request.stream.set;
  const std::size_t size = rows.tree.size(), groups = request.groups.size();
  const auto levels = static_cast<std::size_t>(request.stream.grid_bits() - rows.start);
  ValueState state{
      CoefficientModels(request.groups, rows.tree, rows.codes, rows.first, set.has_vectors(),
                        rows.weights, static_cast<std::size_t>(request.layers)),
      {},
      {}};
  state.coded.nonzero.resize(size);
  state.coded.any.resize(groups);
  state.coded.modes.assign(
      groups, std::vector<std::uint8_t>(levels, set.sps_prediction_flag ? kWide : kUnpredicted));
  state.coded.layers.assign(groups, std::vector<std::uint32_t>(set.coefficient_ranges()));
  state.of_unit.resize(size);
  return state;
}

ValueState start_values(const SliceToDecode& slice, const ComponentRows& rows,
                        std::span<std::int32_t> components) {
  ValueState state = start_values(slice.request, rows);
  const StreamHeader& stream = slice.stream();
  if (!stream.has_base()) return state;
  const BaseState& base = slice.scene.base;
  const std::size_t first_cell = stream.apart() ? 0 : base.first[slice.slice];
  state.coded.cells =
      find_cells(rows.tree, rows.first, stream.lowest_split(rows.start), first_cell);
  if (stream.apart()) return state;
  if (base.values.models) state.models.adopt(*base.values.models, state.coded.cells);
  state.models.start_from_all(base.values.states);
  start_from_base(state.coded.cells, base.values.values, base.weights(), slice.request.planes(),
                  components);
  state.coded.any = base.values.any;
  state.coded.last = base.values.last;
  return state;
}

}  // namespace slf
