// SPDX-License-Identifier: Apache-2.0
#include "attributes/coefficient_models.h"

#include <algorithm>

namespace slf {

CoefficientModels::CoefficientModels(const PlaneGroups& groups, const RahtTree& tree,
                                     std::span<const std::uint64_t> morton,
                                     std::span<const std::uint32_t> first, bool vector,
                                     const CodeWeights& weights, std::size_t layers) {
  if (vector) neighbours_ = find_coefficient_neighbours(tree, morton, first, weights);
  for (const auto& functions : groups) {
    empty_.push_back(functions.empty());
    if (!vector) independent_.emplace_back(functions);
  }
  for (std::size_t layer = 0; vector && layer < layers; ++layer)
    for (const auto& functions : groups) vector_.emplace_back(functions, tree.size(), layer > 0);
}

/// Spec 8.7.2. Row 0 of a slice stays without: it counts as none around other rows.
void CoefficientModels::adopt(const CoefficientModels& base, const SliceCells& cells) {
  if (vector_.empty()) return;
  for (std::size_t i = 1; i < cells.size(); ++i) {
    const std::uint32_t there = base.neighbours_.place[cells.first + i];
    const std::uint32_t here = neighbours_.place[cells.row[i]];
    neighbours_.rows[here].scale = base.neighbours_.rows[there].scale;
    for (std::size_t g = 0; g < vector_.size(); ++g) vector_[g].adopt(base.vector_[g], there, here);
  }
}

CoefficientStates CoefficientModels::states(std::size_t group, std::size_t layer) {
  if (!vector_.empty()) return {vector_[place(group, layer)].states().share(), nullptr};
  return {nullptr, independent_[group].states().share()};
}

void CoefficientModels::start_from(std::size_t group, const CoefficientStates& states,
                                   std::size_t layer) {
  if (!vector_.empty()) return vector_[place(group, layer)].states().start_from(states.vector);
  independent_[group].states().start_from(states.independent);
}

std::vector<CoefficientStates> CoefficientModels::all_states() {
  std::vector<CoefficientStates> all;
  for (std::size_t i = 0; i < std::max(vector_.size(), independent_.size()); ++i)
    all.push_back(states(i % empty_.size(), i / empty_.size()));
  return all;
}

void CoefficientModels::start_from_all(std::span<const CoefficientStates> states) {
  for (std::size_t i = 0; i < states.size(); ++i)
    start_from(i % empty_.size(), states[i], i / empty_.size());
}

/// Spec 8.7.7.
bool CoefficientModels::double_values(const CoefficientRows& rows, std::size_t group,
                                      std::size_t begin, std::size_t end) const {
  for (std::size_t i = begin; i < end; ++i) {
    std::int32_t* row = rows.row(rows.tree.order[i]);
    for (const std::size_t j : planes_of(functions(group))) {
      if (row[j] >= kRefinedLimit || row[j] <= -kRefinedLimit) return false;
      row[j] *= 2;
    }
  }
  return true;
}

}  // namespace slf
