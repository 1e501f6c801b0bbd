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
constexpr double kUsualNodes = 1.5;  // of a point, at all levels
/// ReferenceTerms of a node: half of the places hold something, as a rule.
constexpr double kUsualTerms = 4 + 4 * 8, kMostTerms = 4 + 8 * 8;
/// Nodes of all levels that have siblings, of a point: a merge joins two at the most.
constexpr double kUsualSiblings = 1.33, kMostSiblings = 2;
constexpr double kLatticePoint = 12;
/// PointMove, sorting, MovedPoints; codes and numbers of points while means are found.
constexpr double kMove = 12 + 16 + 12 + 8 + 8;
constexpr std::uint64_t kStates = sizeof(VectorStates) + ReferenceStates::kBytes;  // of a group
/// ReferenceCoefficients, of a row: places and nodes; codes, weights and marks of a level.
constexpr double kRow = 4 + 4 + 8 + 4 + 1;

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
  const FrameState& state = shape.reference->state;
  const double there =
      static_cast<double>(state.bytes(kStates)) +
      static_cast<double>(shape.reference->bytes_moved) +
      kLatticePoint * static_cast<double>(shape.reference->moved.motion.lattice.size());
  const double values = shape.planes > 0 ? of_points : 0;
  double rows = 0;
  if (shape.reference_contexts) {  // a byte of every value stays, four are of a level at work
    rows = (kRow + 4 * static_cast<double>(shape.planes)) * of_points;
    cost.most += static_cast<double>(shape.planes) * of_points;
    cost.usual += static_cast<double>(shape.planes) * of_points;
  }
  cost.usual += there + kUsualTerms * kUsualSiblings * values + rows / 2;
  cost.most += there + kMostTerms * kMostSiblings * values + rows;
  return cost;
}

double cost_of_moving(const FrameState& state, int bits, std::size_t planes) {
  const double values = static_cast<double>(planes);
  const auto points = static_cast<double>(state.cells.codes(bits).size());
  return static_cast<double>(state.bytes(kStates)) + points * (kMove + (8 + 4) * values) +
         most_nodes(static_cast<std::uint64_t>(bits), points) * (kMostNode + 4 * values);
}

}  // namespace slf
