// SPDX-License-Identifier: Apache-2.0
// The octree of a slice, level by level, with the neighbours of every node. Spec 8.4.1.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace slf {

/// Direction index 0 .. 26 of (dx, dy, dz), each -1 .. 1; 13 is the node itself. Spec 8.4.1.
constexpr int direction_index(int dx, int dy, int dz) {
  return (dx + 1) + 3 * (dy + 1) + 9 * (dz + 1);
}
inline constexpr int kSelf = 13;

/// Neighbour of a child: which neighbour of its parent it lies in, and which child of that.
struct ChildNeighbour {
  std::uint8_t node;   ///< direction index
  std::uint8_t child;  ///< 0 .. 7, x the least significant bit
};
/// [child][direction]
inline constexpr std::array<std::array<ChildNeighbour, 27>, 8> kChildNeighbours = [] {
  std::array<std::array<ChildNeighbour, 27>, 8> table{};
  for (int c = 0; c < 8; ++c)
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const int x = (c & 1) + dx, y = (c >> 1 & 1) + dy, z = (c >> 2 & 1) + dz;  // -1 .. 2
          const int node = direction_index((x + 2) / 2 - 1, (y + 2) / 2 - 1, (z + 2) / 2 - 1);
          const int child = (x & 1) | (y & 1) << 1 | (z & 1) << 2;
          table[static_cast<std::size_t>(c)][static_cast<std::size_t>(direction_index(
              dx, dy, dz))] = {static_cast<std::uint8_t>(node), static_cast<std::uint8_t>(child)};
        }
  return table;
}();

/// The occupied nodes of one level, Morton order. Level 0 is the root alone.
struct OctreeLevel {
  /// Which cells around a node are occupied.
  struct Around {
    std::uint32_t directions;  ///< bit d: the one in direction d is; never 13, the node itself
    std::uint32_t first;       ///< place in `neighbours` of the first of them
  };

  std::vector<std::uint64_t> morton;       ///< code of the node's cell at this level
  std::vector<std::uint8_t> occupancy;     ///< bit c: child c is occupied; 0: not coded yet
  std::vector<std::uint32_t> first_child;  ///< index of the first child in the next level
  std::vector<Around> around;
  std::vector<std::uint32_t> neighbours;  ///< nodes around each node, by direction

  std::size_t size() const { return morton.size(); }

  /// The nodes around node n, directions ascending.
  std::span<const std::uint32_t> neighbours_of(std::size_t n) const {
    return std::span(neighbours)
        .subspan(around[n].first, static_cast<std::size_t>(std::popcount(around[n].directions)));
  }

  /// The node in direction d of node n, which is occupied.
  std::uint32_t neighbour(std::size_t n, std::size_t d) const {
    const auto before = static_cast<std::uint32_t>(
        std::popcount(around[n].directions & ((std::uint32_t{1} << d) - 1)));
    return neighbours[around[n].first + before];
  }
};

/// Level 0.
OctreeLevel octree_root();

/// Any level, without what is above: walks down from the root, O(nodes * level).
/// @param cells  codes of its nodes at that level: distinct, ascending, at least one
OctreeLevel octree_level(std::span<const std::uint64_t> cells, int level);

/// The level below one whose occupancies are all known: O(nodes). with_neighbours: needed unless
/// the level is the leaves, whose children are not coded.
/// @param rows  [children + 1] first row of each. Where given, children of one row stay without
///              neighbours
OctreeLevel octree_children(OctreeLevel& parents, bool with_neighbours,
                            std::span<const std::uint32_t> rows = {});

}  // namespace slf
