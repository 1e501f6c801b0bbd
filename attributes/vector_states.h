// SPDX-License-Identifier: Apache-2.0
// What the decisions about the vectors of a group have learnt, and what selects their contexts.
// Spec 8.7.2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "attributes/coefficient_magnitude_model.h"
#include "attributes/coefficient_sign_model.h"
#include "attributes/reference_contexts.h"
#include "entropy/context_shape.h"
#include "entropy/mixed_bit.h"

namespace slf {

/// What the decisions of a group leave to those of its next unit: a value, so that several slices
/// may start from the same.
struct VectorStates {
  /// functions: of the group.
  explicit VectorStates(std::size_t functions)
      : activity(3 * functions, functions > 1 ? kFirstActivity : 0) {}

  static constexpr std::int32_t kFirstActivity = 16;
  static constexpr std::uint32_t kTopSplit = 44, kRuns = 32;

  /// Is a vector other than 0?
  struct Node {
    using Expected = ContextShape<48, 16>;       // magnitude; of the group below
    using Above = ContextShape<5, 5, 5, 5, 3>;   // sizes of three parents, the previous; axis
    using Beside = ContextShape<5, 5, 5, 3, 4>;  // sizes at three faces; axis; below
  };
  /// Is one of its values other than 0, in this run of functions or a later one?
  struct Rest {
    using Expected = ContextShape<kRuns, 48>;  // run; magnitude
    using Before = ContextShape<24, 5, 12>;    // sum so far; functions of the run; magnitude
    using Run = ContextShape<kRuns, 5, 4, 4>;  // run; its functions; parent, previous ahead
  };
  /// Has a function of it a value other than 0?
  struct Any {
    using Sides = ContextShape<20, 20>;  // above; beside
    using Ratio = ContextShape<56, 24>;  // of the vector so far to its activity; magnitude
    using Scale = ContextShape<48, 24>;  // activity; scale
    using Set = ContextShape<2, 17>;     // first of the vector; functions before
  };

  std::vector<std::int32_t> activity;  ///< [planes] running mean of min(magnitude, 7), in 1/4096
  MixedBit<kTopSplit + 1, Node::Expected, Node::Above, Node::Beside> node;
  MixedBit<kRuns, Rest::Expected, Rest::Before, Rest::Run> rest;
  MixedBit<Any::Set::kCount, Any::Sides, Any::Ratio, Any::Scale> any;
  CoefficientMagnitudeModel magnitude;
  CoefficientSignModel sign;
  std::optional<ReferenceStates> reference;  ///< nothing until a frame is predicted

  /// Before a frame that is predicted.
  void add_reference() {
    if (reference) return;
    reference.emplace();
    node.weigh_more(ReferenceStates::kFirstWeight);
    magnitude.weigh_more(ReferenceStates::kFirstWeight);
  }
};

}  // namespace slf
