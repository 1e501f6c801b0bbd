// SPDX-License-Identifier: Apache-2.0
// The children of a node on the encoder's side: predictions of planes that are predicted in
// different ways, and the coefficients these would have. Spec 8.7.6.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "attributes/level_prediction.h"
#include "attributes/raht_tree.h"

namespace slf {

/// Predictions of one node after the other, of the same planes.
class PredictedNode {
 public:
  /// modes: of the planes.
  explicit PredictedNode(std::span<const std::uint8_t> modes);
  PredictedNode(const PredictedNode&) = delete;
  PredictedNode& operator=(const PredictedNode&) = delete;

  /// Are any of the planes? Else they need no means.
  bool is_predicted() const { return used_.back() != kUnpredicted; }

  /// own: the merges of the node. values, means: rows of the planes, as for predict_children.
  void predict(const TransformLevel& level, std::size_t n, std::span<const Merge> own, Lanes values,
               Lanes means, ConstLanes reference);

  /// What is predicted of the coefficients of a merge, by its right row; nullptr: nothing is.
  const std::int32_t* coefficients(std::uint32_t right) const;

  /// Adds what is predicted to the children's values, after the inverse transform.
  void correct(Lanes values) const;

 private:
  std::size_t child_of(std::uint32_t row) const;
  void predict_block(std::size_t block, Lanes values, Lanes means, ConstLanes reference);

  std::span<const std::uint8_t> modes_;
  std::vector<std::uint8_t> used_;  // of the modes, ascending
  std::array<NodePrediction, kModesWithReference> plans_;
  const NodePrediction* plan_;             // any has the children
  std::vector<Corrections> corrections_;   // [blocks of kPredictionLanes]
  std::vector<std::int32_t> transformed_;  // [child][planes]
};

}  // namespace slf
