#include "geometry/octree_levels.h"

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
  return root;
}

namespace {

/// Index of a node's child in the next level, or -1.
std::int32_t child_index(const OctreeLevel& level, std::int32_t node, int child) {
  if (node < 0) return -1;
  const auto n = static_cast<std::size_t>(node);
  const unsigned occupancy = level.occupancy[n];
  if (!(occupancy >> child & 1u)) return -1;
  const unsigned before = occupancy & ((1u << child) - 1);
  return static_cast<std::int32_t>(level.first_child[n]) + std::popcount(before);
}

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
  for (std::size_t n = 0, child = 0; n < parents.size(); ++n)
    for (unsigned c = 0; c < 8; ++c) {
      if (!(parents.occupancy[n] >> c & 1u)) continue;
      for (std::size_t d = 0; d < 27; ++d) {
        const ChildNeighbour& at = kChildNeighbours[c][d];
        children.neighbours[child][d] =
            child_index(parents, parents.neighbours[n][at.node], at.child);
      }
      ++child;
    }
  return children;
}

}  // namespace slf
