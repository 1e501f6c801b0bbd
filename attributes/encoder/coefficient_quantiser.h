// SPDX-License-Identifier: Apache-2.0
// Quantisation of transform coefficients against the prediction a decoder will make: a closed loop,
// level by level. Mirror of raht_inverse. Informative.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "attributes/coefficient_models.h"
#include "attributes/encoder/rate_model.h"
#include "attributes/raht_tree.h"
#include "attributes/slice_cells.h"
#include "attributes/transform_levels.h"

namespace slf {

struct Quantised {
  std::vector<std::vector<std::uint8_t>> modes;  ///< [groups][levels] cu_prediction, from the first
                                                 ///< level that is coded here
  std::vector<std::int32_t> values;              ///< [rows][planes] what a decoder gets
  std::vector<RateModel> rates;                  ///< [groups] what was learnt of the bits
};

/// The base that a slice goes on from, or of slices apart its cells alone, all zero. Spec 8.2.
struct QuantisedBase {
  const SliceCells& cells;                     ///< of the slice
  int level;                                   ///< of the cells
  CodeWeights weights;                         ///< of the cells of the scene
  std::span<const std::int32_t> coefficients;  ///< [cells of the scene][planes] quantised
  const Quantised* quantised;                  ///< nullptr where slices are apart
};

struct QuantiserInput {
  const RahtTree& tree;
  std::span<const std::uint64_t> morton;  ///< of the points of a slice, or of the cells of a base
  int depth = 0;                          ///< of the slice
  const PlaneGroups& groups;
  std::span<const std::uint32_t> steps;  ///< [planes]
  bool predict = false;
  double rdo = 0;   ///< 0 .. 1
  int dropped = 0;  ///< levels below the rows: of a base those of its slices
  CodeWeights weights{};
  const QuantisedBase* base = nullptr;        ///< nullptr: the tree is coded from the root
  const ReferenceMeans* reference = nullptr;  ///< of a frame that is predicted, without a base
};

/// @param coefficients  [rows][planes] of raht_forward; replaced by quantised values, in the rows
///                      of a slice's cells by those of the base
/// The same result for any number of threads. O(rows * planes), several times that with prediction.
Quantised quantise_coefficients(const QuantiserInput& input, std::span<std::int32_t> coefficients,
                                int threads);

}  // namespace slf
