#include "codec/base_encoder.h"

#include <numeric>

#include "attributes/raht_forward.h"
#include "entropy/range_encoder.h"
#include "geometry/octree_encoder.h"

namespace slf {
namespace {

/// The units of a layer of the coefficients.
void encode_layer(const SliceCoding& coding, const RahtTree& tree, std::uint32_t layer,
                  EncodedBase& base) {
  const SequenceParameterSet& set = coding.set;
  std::vector<std::int32_t> values = values_of_layer(coding, layer, base.coefficients);
  const CoefficientRows rows{tree, values, coding.planes()};
  std::size_t begin = 0;
  for (std::uint32_t r = 0; r < set.base_coefficient_ranges(); ++r) {
    const int level = static_cast<int>(set.coefficient_end(r));
    const std::size_t end = order_end(tree, 3 * (coding.grid_bits() - level));
    for (std::uint32_t g = 0; g < coding.groups.size(); ++g) {
      if (layer >= set.layers_of(g)) continue;
      RangeEncoder encoder;
      base.models.front().code(encoder, rows, g, begin, end, layer);
      SliceUnitHeader header{SliceUnitHeader::kBase, r, g, layer, {}};
      if (layer > 0) {
        base.units.push_back(part_unit(UnitType::kRefinement, header, encoder.finish(), set));
        continue;
      }
      header.cu_prediction = modes_of_range(set, r, base.quantised.modes[g], 0);
      base.units.push_back(coefficient_unit(header, encoder.finish(), coding));
    }
    begin = end;
  }
}

}  // namespace

EncodedBase encode_base_geometry(const SliceCoding& coding, const SceneLayout& layout) {
  EncodedBase base{OccupancyStates(layout.table.num_points()), {}, {}, {}, {}, {}};
  if (layout.base_levels == 0) return base;
  OctreeEncoder octree(layout.cells, layout.base_levels, base.geometry);
  for (std::uint32_t r = 0; r < coding.set.base_geometry_ranges(); ++r) {
    SliceUnitHeader header;
    header.range = r;
    const int end = static_cast<int>(coding.set.geometry_end(r));
    const auto body = end < layout.base_levels || coding.set.sps_num_functions == 0
                          ? octree.encode(end)
                          : octree.encode(end, layout.classes);
    base.units.push_back(part_unit(UnitType::kGeometry, std::move(header), body, coding.set));
  }
  base.geometry = octree.states();
  return base;
}

void encode_base_components(const SliceCoding& coding, const SceneLayout& layout,
                            std::vector<std::int32_t> input, int threads, EncodedBase& base) {
  if (layout.base_levels == 0 || coding.planes() == 0) return;
  const SequenceParameterSet& set = coding.set;
  const int dropped = coding.grid_bits() - layout.base_levels;
  std::vector<std::uint64_t> codes = layout.cells;
  for (auto& code : codes) code <<= 3 * dropped;
  const RahtTree tree = build_raht_tree(codes, layout.weights());
  raht_forward(tree, static_cast<int>(coding.planes()), input, threads);
  base.coefficients = std::move(input);
  base.quantised = quantise_coefficients(
      {tree, codes, coding.grid_bits(), coding.groups, coding.steps, set.sps_prediction_flag != 0,
       coding.rdo, dropped, layout.weights(), nullptr},
      base.coefficients, threads);
  std::vector<std::uint32_t> first(tree.size() + 1);
  std::iota(first.begin(), first.end(), 0u);
  CoefficientModels& models = base.models.emplace_back(
      coding.groups, tree, codes, first, set.has_vectors(), layout.weights(), set.num_layers());
  for (std::uint32_t layer = 0; layer < set.num_layers(); ++layer)
    encode_layer(coding, tree, layer, base);
  base.states = models.all_states();
}

}  // namespace slf
