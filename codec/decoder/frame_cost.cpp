// SPDX-License-Identifier: Apache-2.0
#include "codec/decoder/frame_cost.h"

#include <algorithm>

#include "attributes/vector_states.h"
#include "geometry/occupancy_states.h"

namespace slf {
namespace {

/// Bytes of a node: its code, and its brick, which takes one of four places of a table. A brick has
/// ten nodes usually, one at the worst.
constexpr int kBrick = 4 * 32, kUsualBrick = kBrick / 10;
constexpr double kUsualNode = 8 + kUsualBrick, kMostNode = 8 + kBrick;
constexpr double kUsualNodes = 1.5;   // of a point, at all levels
constexpr double kTerms = 4 + 8 * 8;  // ReferenceTerms, of a node of one level
constexpr double kLatticePoint = 12;
constexpr std::uint64_t kStates = sizeof(VectorStates) + ReferenceStates::kBytes;  // of a group
/// ReferenceCoefficients, of a row: marks, places; nodes, codes and weights of a level.
constexpr double kRow = 1 + 4 + 4 + 8 + 4 + 1;

/// Nodes that an octree of so many points has at most, at all levels.
double most_nodes(std::uint64_t levels, double points) {
  double nodes = 0, full = 1;
  for (std::uint64_t level = 0; level <= levels; ++level, full *= 8)
    nodes += std::min(full, points);
  return nodes;
}

/// After each unit.
double kept_states(const DecodeShape& shape, std::uint64_t points) {
  const auto octree =
      static_cast<double>(OccupancyStates::bytes(points) + OccupancyStates::kReferenceBytes);
  const double values = shape.planes > 0 ? kStates : 0;
  return static_cast<double>(shape.geometry_units) * octree +
         static_cast<double>(shape.coefficient_units) * values;
}

}  // namespace

FrameCost frame_cost(const DecodeShape& shape, std::uint64_t points) {
  if (!shape.kept) return {};
  const double of_points = static_cast<double>(points),
               means = 4 * static_cast<double>(shape.planes), states = kept_states(shape, points);
  FrameCost cost{states + (kUsualNode + means) * kUsualNodes * of_points,
                 states + (kMostNode + means) * most_nodes(shape.levels, of_points)};
  if (shape.reference == nullptr) return cost;
  const auto& [state, moved] = *shape.reference;
  const double there = static_cast<double>(state.bytes(kStates)) +
                       kLatticePoint * static_cast<double>(moved.motion.lattice.size());
  double terms = shape.planes > 0 ? kTerms * of_points : 0;
  if (shape.reference_contexts) {  // a byte of every value stays, four are of a level at work
    terms += (kRow + 4 * static_cast<double>(shape.planes)) * of_points;
    cost.most += static_cast<double>(shape.planes) * of_points;
    cost.usual += static_cast<double>(shape.planes) * of_points;
  }
  cost.usual += there + terms / 2;
  cost.most += there + terms;
  return cost;
}

}  // namespace slf
