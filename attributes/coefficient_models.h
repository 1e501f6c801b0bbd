// SPDX-License-Identifier: Apache-2.0
// Quantised coefficients of the base or of a slice, for both directions: groups, states, models.
// Spec 8.7.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "attributes/coefficient_layout.h"
#include "attributes/coefficient_neighbours.h"
#include "attributes/independent_coefficients.h"
#include "attributes/slice_cells.h"
#include "attributes/vector_coefficients.h"

namespace slf {

/// Functions of every group, ascending.
using PlaneGroups = std::vector<std::vector<std::uint16_t>>;

/// Planes of a group, ascending: 3 k + c of its functions.
inline std::vector<std::size_t> planes_of(const std::vector<std::uint16_t>& functions) {
  std::vector<std::size_t> planes;
  for (const std::size_t k : functions)
    for (std::size_t c = 0; c < 3; ++c) planes.push_back(3 * k + c);
  return planes;
}

/// States of a group as they were at some time, never changed; by default fresh ones. Cheap to
/// copy.
struct CoefficientStates {
  StatesInUse<VectorStates>::Shared vector;  ///< of the coder in question
  StatesInUse<IndependentStates>::Shared independent;
};

/// What coding the groups of the base or of a slice leaves behind: states that live on from level
/// range to level range, and the vectors around which the next are coded.
class CoefficientModels {
 public:
  /// morton, first, weights: as for find_coefficient_neighbours; for the vector coder alone.
  /// layers: of all groups; more than one with the vector coder alone.
  CoefficientModels(const PlaneGroups& groups, const RahtTree& tree,
                    std::span<const std::uint64_t> morton, std::span<const std::uint32_t> first,
                    bool vector, const CodeWeights& weights = {}, std::size_t layers = 1);

  /// A slice's cells take vectors and scales of the base's rows. Once, before any coding; `base`
  /// has coded all that it is going to. O(cells * planes).
  void adopt(const CoefficientModels& base, const SliceCells& cells);

  /// The states of a layer of a group after its last unit. The model goes on with a copy.
  CoefficientStates states(std::size_t group, std::size_t layer = 0);
  /// The next unit starts from them. Several models on several threads may have the same.
  void start_from(std::size_t group, const CoefficientStates& states, std::size_t layer = 0);
  /// The same of all groups, layer by layer.
  std::vector<CoefficientStates> all_states();
  void start_from_all(std::span<const CoefficientStates> states);

  /// Before a unit of a frame that is predicted.
  void predict_from(std::size_t group, const GroupReference& reference) {
    if (!vector_.empty()) vector_[group].predict_from(reference);
  }

  /// Codes rows order[begin .. end) of a layer of a group; see VectorCoefficients::code.
  template <class Coder>
  bool code(Coder& coder, const CoefficientRows& rows, std::size_t group, std::size_t begin,
            std::size_t end, std::size_t layer = 0) {
    if (empty_[group]) return true;
    if constexpr (!Coder::kDecodes)
      if (all_zero(rows, group, begin, end, layer > 0)) return true;  // an empty codeword
    if (!vector_.empty())
      return vector_[place(group, layer)].code(
          coder, rows, neighbours_, group > 0 ? &vector_[place(group - 1, layer)] : nullptr, begin,
          end);
    return independent_[group].code(coder, rows, begin, end);
  }
  /// A refinement whose codeword is empty. False: a value is too large for it.
  bool double_values(const CoefficientRows& rows, std::size_t group, std::size_t begin,
                     std::size_t end) const;

 private:
  std::size_t place(std::size_t group, std::size_t layer) const {
    return layer * empty_.size() + group;
  }
  const std::vector<std::uint16_t>& functions(std::size_t group) const {
    return vector_.empty() ? independent_[group].functions() : vector_[group].functions();
  }
  /// bits: of the last bits of all values.
  bool all_zero(const CoefficientRows& rows, std::size_t group, std::size_t begin, std::size_t end,
                bool bits) const {
    for (std::size_t i = begin; i < end; ++i)
      if (has_any(rows.row(rows.tree.order[i]), functions(group), bits ? 1 : -1)) return false;
    return true;
  }

  CoefficientNeighbours neighbours_;
  std::vector<std::uint8_t> empty_;         // groups without functions to code
  std::vector<VectorCoefficients> vector_;  // layer by layer; one of the two is empty
  std::vector<IndependentCoefficients> independent_;
};

}  // namespace slf
