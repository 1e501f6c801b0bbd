// SPDX-License-Identifier: Apache-2.0
// The children of a node predicted from what is known around them. Spec 8.7.6.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "attributes/node_prediction.h"
#include "attributes/transform_levels.h"

namespace slf {

/// Values after a prediction are at most this. With means clamped to 2^17 and weights up to 2^24 a
/// correction is below 0.39 * 2^30, and 63 merges of coefficients below 2^27 take 2^29 to at most
/// 1.12 * 2^30: the sum has 32 bits. Spec 8.8.2.
inline constexpr std::int32_t kPredictedLimit = 1 << 29;

/// Planes worked on together.
inline constexpr std::size_t kPredictionLanes = 48;

/// Rows of planes, and the first of those a call works on.
struct Lanes {
  std::int32_t* first;
  std::size_t stride;
  std::int32_t* row(std::size_t r) const { return first + r * stride; }
};

/// The same of rows that are read alone.
struct ConstLanes {
  const std::int32_t* first;
  std::size_t stride;
  const std::int32_t* row(std::size_t r) const { return first + r * stride; }
  /// From lane j on; where there are no rows, none.
  ConstLanes from(std::size_t j) const { return {first == nullptr ? nullptr : first + j, stride}; }
};

/// Means of a node of `weight` points, of the values in its row.
void node_means(const std::int32_t* values, std::uint32_t weight, std::int32_t* means,
                std::size_t lanes);

/// Means of level.means[begin .. end) into means [slot][lanes]. To be called for a node before its
/// children are predicted, and with them all.
void level_means(const TransformLevel& level, std::size_t begin, std::size_t end, Lanes values,
                 Lanes means, std::size_t lanes);

/// What to add to each child, [child][kPredictionLanes], without the mean of all; lanes at most
/// kPredictionLanes.
using Corrections = std::array<std::array<std::int32_t, kPredictionLanes>, 8>;
/// reference: means of the nodes that the plan's terms name, where it has such
void predict_children(const NodePrediction& plan, Lanes values, Lanes means, ConstLanes reference,
                      std::size_t lanes, Corrections& out);

/// Adds them to the children's values.
void add_corrections(const NodePrediction& plan, const Corrections& corrections, Lanes values,
                     std::size_t lanes);

}  // namespace slf
