#include "geometry/occupancy_model.h"

namespace slf {
namespace {

/// Bit 0: the lower half along the axis holds a child, bit 1: the upper.
unsigned occupied_halves(unsigned occupancy, unsigned axis) {
  constexpr std::array<unsigned, 3> kLower = {0x55, 0x33, 0x0F};
  return (occupancy & kLower[axis] ? 1u : 0u) | (occupancy & ~kLower[axis] ? 2u : 0u);
}

/// The 2 x 2 columns along the axis that hold a child, the lower of the other axes first.
unsigned occupied_columns(unsigned o, unsigned axis) {
  if (axis == 2) return (o | o >> 4) & 15;
  if (axis == 1) return ((o | o >> 2) & 3) | ((o | o >> 2) >> 2 & 12);
  const unsigned m = o | o >> 1;
  return (m & 1) | (m >> 1 & 2) | (m >> 2 & 4) | (m >> 3 & 8);
}

}  // namespace

OccupancyModel::OccupancyModel(std::uint64_t points) {
  const int useful = std::max(static_cast<int>(std::bit_width(points)) + 4, 10);
  hashed_bits_ = std::min(kMostHashedBits, useful);
  for (std::size_t i = 0; i < kContexts; ++i)
    contexts_[i].resize(std::size_t{1} << (kContextBits[i] > 0 ? kContextBits[i] : hashed_bits_));
}

OccupancyModel::Node OccupancyModel::node_context(const OctreeLevel& nodes, std::size_t n) {
  Node node;
  for (std::size_t d = 0; d < 27; ++d) {
    const std::int32_t neighbour = nodes.neighbours[n][d];
    if (neighbour < 0 || d == kSelf) continue;
    node.neighbours |= 1u << d;
    const WindowPart& part = kWindowParts[d];
    if (static_cast<std::size_t>(neighbour) >= n) {
      node.unknown |= part.all;
      continue;
    }
    const unsigned occupancy = nodes.occupancy[static_cast<std::size_t>(neighbour)];
    for (std::size_t i = 0; i < static_cast<std::size_t>(part.size); ++i)
      if (occupancy >> part.child[i] & 1u) node.occupied |= part.bit[i];
  }
  const auto latest = history_.at(nodes.morton[n]);
  for (unsigned axis = 0; axis < 3; ++axis) {
    node.halves |= occupied_halves(latest[axis], axis) << (2 * axis);
    node.columns[axis] = occupied_columns(latest[3 + axis], axis);
  }
  return node;
}

}  // namespace slf
