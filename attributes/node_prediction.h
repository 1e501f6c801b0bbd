// SPDX-License-Identifier: Apache-2.0
// What the children of a node are predicted from, and how much of each: for all planes. Spec 8.7.6.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "attributes/transform_levels.h"

namespace slf {

/// cu_prediction. kFromReference: by what the reference has there; added to another it is half of
/// that, and half of the other. Else weights fall with the square of the distance, or with its
/// fourth power.
enum PredictionMode : std::uint8_t {
  kUnpredicted = 0,
  kWide = 1,         ///< square: smooth planes
  kSharpDamped = 2,  ///< fourth power, three quarters of it
  kSharp = 3,
  kFromReference = 4,
};
inline constexpr std::uint32_t kPredictionModes = 4, kModesWithReference = 8;

/// What the corrections of the children of one node are made of.
struct NodePrediction {
  struct Term {
    static constexpr std::int32_t kSlot = 0, kReference = -1;
    std::uint32_t index;    ///< row of `values`, slot of `means`, or node of the reference
    std::int32_t weight;    ///< of 4096
    std::int32_t root_q30;  ///< 1 / sqrt(points) of a row; else kSlot or kReference
  };
  struct Child {
    std::uint32_t row = 0;
    std::int32_t share_q30 = 0;  ///< of the node's points
    std::int32_t root_q19 = 0;   ///< sqrt(points), times what the mode takes of the prediction
    std::int32_t others = 0;     ///< sum of its terms' weights
    std::uint32_t terms = 0;
    std::array<Term, 14> term;
  };
  std::uint32_t slot = 0;  ///< of its own mean
  std::uint32_t children = 0;
  std::array<Child, 8> child;
};

/// Weights and places, for all planes. Node n branches; mode 1 .. 7, from 4 on of a level with a
/// reference.
void plan_node(const TransformLevel& level, std::size_t n, std::uint32_t mode,
               NodePrediction& plan);

}  // namespace slf
