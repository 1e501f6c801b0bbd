// SPDX-License-Identifier: Apache-2.0
#include "codec/encoder/component_encoder.h"

#include <algorithm>

#include "entropy/range_encoder.h"

namespace slf {
namespace {

/// Values of every group with as many bits less as layers follow. Spec 8.7.7.
std::vector<std::int32_t> without_bits(const SliceCoding& coding, std::uint32_t layer,
                                       std::span<const std::int32_t> values) {
  std::vector<std::int32_t> divisor(coding.planes(), 1);
  for (std::size_t g = 0; g < coding.groups.size(); ++g)
    for (const std::size_t j : planes_of(coding.groups[g]))
      divisor[j] = 1 << (std::max(coding.set.layers_of(g), layer + 1) - 1 - layer);
  std::vector<std::int32_t> coarser(values.begin(), values.end());
  for (std::size_t i = 0; i < coarser.size(); ++i) coarser[i] /= divisor[i % divisor.size()];
  return coarser;
}

}  // namespace

Result<CodedUnit, InputError> ComponentEncoder::encode(SliceUnitHeader ids) {
  const SequenceParameterSet& set = coding_.set;
  const int bits = coding_.grid_bits();
  const CoefficientRows rows{tree_, values_of(ids.layer), coding_.planes()};
  RangeEncoder encoder;
  models_.code(encoder, rows, ids.group, order_at(tree_, bits, set.coefficient_begin(ids.range)),
               order_at(tree_, bits, set.coefficient_end(ids.range)), ids.layer);
  if (ids.layer > 0) return part_unit(UnitType::kRefinement, std::move(ids), encoder.finish(), set);
  ids.cu_prediction = modes_of(ids);
  return coefficient_unit(std::move(ids), encoder.finish(), coding_);
}

std::span<std::int32_t> ComponentEncoder::values_of(std::uint32_t layer) {
  if (coding_.set.num_layers() == 1) return values_;
  if (layer != layer_) of_layer_ = without_bits(coding_, layer, values_);
  layer_ = layer;
  return of_layer_;
}

/// cu_prediction of the levels of a range.
std::vector<std::uint32_t> ComponentEncoder::modes_of(const SliceUnitHeader& ids) const {
  const SequenceParameterSet& set = coding_.set;
  const auto& modes = quantised_.modes[ids.group];
  std::vector<std::uint32_t> coded;
  if (set.sps_prediction_flag == 0) return coded;
  for (std::size_t level = set.coefficient_begin(ids.range); level < set.coefficient_end(ids.range);
       ++level) {
    const std::size_t i = level - static_cast<std::size_t>(start_);
    coded.push_back(i < modes.size() ? modes[i] : 0u);
  }
  return coded;
}

}  // namespace slf
