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

OccupancyModel::OccupancyModel(std::uint64_t points)
    : faces_(std::size_t{1} << kFacesBits),
      corner_(std::size_t{1} << kCornerBits),
      counts_(std::size_t{1} << kCountsBits),
      halves_(std::size_t{1} << kHalvesBits) {
  const int useful = std::max(static_cast<int>(std::bit_width(points)) + 4, 10);
  hashed_bits_ = std::min(kMostHashedBits, useful);
  for (auto& contexts : hashed_) contexts.resize(std::size_t{1} << hashed_bits_);
}

OccupancyModel::Node OccupancyModel::node_contexts(const OctreeLevel& nodes, std::size_t n) {
  Node node;
  const std::uint32_t neighbours = nodes.around[n];
  Window occupied = 0, unknown = 0;
  for (std::uint32_t left = neighbours; left != 0; left &= left - 1) {
    const auto d = static_cast<std::size_t>(std::countr_zero(left));
    const unsigned occupancy = nodes.occupancy[static_cast<std::size_t>(nodes.neighbours[n][d])];
    occupied |= std::rotl(kOwnCells[occupancy], kWindowShift[d]) & kWindowParts[d];
    unknown |= occupancy == 0 ? kWindowParts[d] : 0;
  }
  const auto latest = history_.at(nodes.morton[n]);
  node.halves = 0;
  std::uint64_t columns = 1;
  for (unsigned axis = 0; axis < 3; ++axis) {
    node.halves |= occupied_halves(latest[axis], axis) << (2 * axis);
    columns = columns << 4 | occupied_columns(latest[3 + axis], axis);
  }
  node.neighbours_class = std::min(static_cast<std::uint32_t>(std::popcount(neighbours)) / 3, 7u);
  node.neighbours = neighbours * kFactorA;
  node.columns = columns * kFactorA;
  node.neighbours_group = group(kByNeighbours, node.neighbours, 0, 4);
  node.columns_group = group(kByColumns, node.columns, 0, 4);
  for (unsigned c = 0; c < 8; ++c) {
    Child& child = node.child[c];
    const Surroundings around = surroundings(occupied, unknown, c);
    child.faces = outer_faces_of(around, c);
    child.occupied = static_cast<unsigned>(std::popcount(around.occupied));
    child.unknown = static_cast<unsigned>(std::popcount(around.unknown));
    child.corner = corner_of(neighbours, c);
    child.cells = around.occupied * kFactorA + (around.unknown << 3 | c) * kFactorB;
    if (c < 4) child.group = group(kByCells, child.cells, 0, 3);
  }
  return node;
}

}  // namespace slf
