#include "geometry/octree_levels.h"

#include <algorithm>
#include <bit>

#include "bitstream/multiversion.h"

namespace slf {

OctreeLevel octree_root() {
  OctreeLevel root;
  root.morton = {0};
  root.parent = {0};
  root.occupancy = {0};
  root.neighbours.resize(1);
  root.neighbours[0].fill(-1);
  root.neighbours[0][kSelf] = 0;
  root.around = {0};
  return root;
}

namespace {

std::size_t lowest_bit(unsigned bits) { return static_cast<std::size_t>(std::countr_zero(bits)); }

/// The eight nodes that a child's neighbours are children of, its parent included.
struct NodesAround {
  struct Node {
    std::uint8_t direction;                       ///< from the parent
    std::uint8_t children;                        ///< bit c: child c is a neighbour, or the child
    std::array<std::uint8_t, 8> child_direction;  ///< from the child
  };
  std::array<Node, 8> node{};
};
/// [child]
constexpr std::array<NodesAround, 8> kNodesAround = [] {
  std::array<NodesAround, 8> table{};
  for (std::size_t c = 0; c < 8; ++c) {
    std::size_t count = 0;
    for (std::uint8_t d = 0; d < 27; ++d) {
      const ChildNeighbour& at = kChildNeighbours[c][d];
      std::size_t i = 0;
      while (i < count && table[c].node[i].direction != at.node) ++i;
      count = std::max(count, i + 1);
      NodesAround::Node& node = table[c].node[i];
      node.direction = at.node;
      node.children = static_cast<std::uint8_t>(node.children | 1u << at.child);
      node.child_direction[at.child] = d;
    }
  }
  return table;
}();

}  // namespace

SLF_MULTIVERSION_ALL
OctreeLevel octree_children(OctreeLevel& parents, bool with_neighbours) {
  OctreeLevel children;
  std::uint32_t count = 0;
  parents.first_child.resize(parents.size());
  for (std::size_t n = 0; n < parents.size(); ++n) {
    parents.first_child[n] = count;
    count += static_cast<std::uint32_t>(std::popcount(parents.occupancy[n]));
  }
  children.morton.reserve(count);
  children.parent.reserve(count);
  for (std::size_t n = 0; n < parents.size(); ++n)
    for (unsigned c = 0; c < 8; ++c)
      if (parents.occupancy[n] >> c & 1u) {
        children.morton.push_back(parents.morton[n] << 3 | c);
        children.parent.push_back(static_cast<std::uint32_t>(n));
      }
  children.occupancy.assign(count, 0);
  if (!with_neighbours) return children;

  children.neighbours.resize(count);
  children.around.reserve(count);
  for (std::size_t n = 0, child = 0; n < parents.size(); ++n)
    for (unsigned own = parents.occupancy[n]; own != 0; own &= own - 1) {
      OctreeLevel::Neighbours& neighbours = children.neighbours[child++];
      neighbours.fill(-1);
      std::uint32_t found = 0;
      for (const NodesAround::Node& around : kNodesAround[lowest_bit(own)].node) {
        const std::int32_t there = parents.neighbours[n][around.direction];
        if (there < 0) continue;
        const unsigned occupancy = parents.occupancy[static_cast<std::size_t>(there)];
        const auto first =
            static_cast<std::int32_t>(parents.first_child[static_cast<std::size_t>(there)]);
        for (unsigned left = occupancy & around.children; left != 0; left &= left - 1) {
          const unsigned before = occupancy & ((left & -left) - 1);
          const unsigned direction = around.child_direction[lowest_bit(left)];
          neighbours[direction] = first + std::popcount(before);
          found |= 1u << direction;
        }
      }
      children.around.push_back(found & ~(1u << kSelf));
    }
  return children;
}

}  // namespace slf
