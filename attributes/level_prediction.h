// The children of a node predicted from what is known around them. Spec 8.7.6.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "attributes/transform_levels.h"

namespace slf {

/// cu_prediction. Weights fall with the square of the distance, or with its fourth power.
enum PredictionMode : std::uint8_t {
  kUnpredicted = 0,
  kWide = 1,         ///< square: smooth planes
  kSharpDamped = 2,  ///< fourth power, three quarters of it
  kSharp = 3,
};
inline constexpr std::uint32_t kPredictionModes = 4;

/// Values after a prediction are at most this. With means clamped to 2^17 and weights up to 2^24 a
/// correction is below 0.39 * 2^30, and 63 merges of coefficients below 2^27 take 2^29 to at most
/// 1.12 * 2^30: the sum has 32 bits. Spec 8.8.2.
inline constexpr std::int32_t kPredictedLimit = 1 << 29;

/// Planes worked on together.
inline constexpr std::size_t kPredictionLanes = 48;

/// What the corrections of the children of one node are made of.
struct NodePrediction {
  struct Term {
    std::uint32_t index;    ///< row of `values`, or slot of `means`
    std::int32_t weight;    ///< of 4096
    std::int32_t root_q30;  ///< 1 / sqrt(points) of a row; 0: index is a slot
  };
  struct Child {
    std::uint32_t row = 0;
    std::int32_t share_q30 = 0;  ///< of the node's points
    std::int32_t root_q19 = 0;   ///< sqrt(points), times what the mode takes of the prediction
    std::int32_t others = 0;     ///< sum of its terms' weights
    std::uint32_t terms = 0;
    std::array<Term, 6> term;
  };
  std::uint32_t slot = 0;  ///< of its own mean
  std::uint32_t children = 0;
  std::array<Child, 8> child;
};

/// Weights and places, for all planes. Node n branches; mode 1 .. 3.
void plan_node(const TransformLevel& level, std::size_t n, std::uint32_t mode,
               NodePrediction& plan);

/// Rows of planes, and the first of those a call works on.
struct Lanes {
  std::int32_t* first;
  std::size_t stride;
  std::int32_t* row(std::size_t r) const { return first + r * stride; }
};

/// Means of level.means[begin .. end) into means [slot][lanes]. To be called for a node before its
/// children are predicted, and with them all.
void level_means(const TransformLevel& level, std::size_t begin, std::size_t end, Lanes values,
                 Lanes means, std::size_t lanes);

/// What to add to each child, [child][kPredictionLanes], without the mean of all; lanes at most
/// kPredictionLanes.
using Corrections = std::array<std::array<std::int32_t, kPredictionLanes>, 8>;
void predict_children(const NodePrediction& plan, Lanes values, Lanes means, std::size_t lanes,
                      Corrections& out);

/// Adds them to the children's values.
void add_corrections(const NodePrediction& plan, const Corrections& corrections, Lanes values,
                     std::size_t lanes);

/// 1 / sqrt(weight), spec 8.7.6; of most weights from a table.
std::int32_t reciprocal_root_q30(std::uint32_t weight);

}  // namespace slf
