// SPDX-License-Identifier: Apache-2.0
#include "geometry/octree_levels.h"

#include <algorithm>
#include <bit>

#include "base/multiversion.h"
#include "geometry/occupancy_window.h"

namespace slf {

OctreeLevel octree_root() {
  OctreeLevel root;
  root.morton = {0};
  root.occupancy = {0};
  root.around = {{0, 0}};
  return root;
}

namespace {

/// How many of the children before child c there are. [occupancy][c]
SLF_TABLE std::array<std::array<std::uint8_t, 8>, 256> kChildrenBefore = [] {
  SLF_TABLE_BEGINS;
  std::array<std::array<std::uint8_t, 8>, 256> table{};
  for (unsigned o = 0; o < 256; ++o)
    for (unsigned c = 0; c < 8; ++c)
      table[o][c] = static_cast<std::uint8_t>(std::popcount(o & ((1u << c) - 1)));
  return table;
}();

/// The cells of the level below around a node's children, and its children.
struct ChildWindow {
  Window occupied = 0;
  /// [direction][child] index of the child of the neighbour there, where both are.
  std::array<std::array<std::uint32_t, 8>, 27> node;

  /// m: the neighbour in direction d.
  void add(const OctreeLevel& parents, std::size_t d, std::size_t m) {
    const unsigned occupancy = parents.occupancy[m];
    occupied |= turned(kOwnCells[occupancy], kWindowShift[d]) & kWindowParts[d];
    const std::uint32_t first = parents.first_child[m];
    const auto& before = kChildrenBefore[occupancy];
    for (std::size_t c = 0; c < 8; ++c) node[d][c] = first + before[c];  // all: no branches
  }
};

ChildWindow window_of(const OctreeLevel& parents, std::size_t n) {
  ChildWindow window;
  const std::uint32_t* neighbour = parents.neighbours.data() + parents.around[n].first;
  for (std::uint32_t left = parents.around[n].directions; left != 0; left &= left - 1)
    window.add(parents, static_cast<std::size_t>(std::countr_zero(left)), *neighbour++);
  window.add(parents, kSelf, n);
  return window;
}

/// The 3 x 3 x 3 cells at the lower corner of a window as directions.
std::uint32_t directions_of(Window cells) {
  const Window planes =
      (cells & 0x000700070007u) | (cells >> 1 & 0x003800380038u) | (cells >> 2 & 0x01C001C001C0u);
  return static_cast<std::uint32_t>((planes & 0x1FFu) | (planes >> 7 & 0x3FE00u) |
                                    (planes >> 14 & 0x7FC0000u));
}

/// Adds neighbours to the children of node n, or to those of them with more than one row.
/// around: that of the first of them.
void add_neighbours(const OctreeLevel& parents, std::size_t n, const std::uint32_t* rows,
                    OctreeLevel::Around* around, std::vector<std::uint32_t>& neighbours) {
  const ChildWindow window = window_of(parents, n);
  const auto first = static_cast<std::uint32_t>(neighbours.size());
  std::array<std::uint32_t, std::size_t{8} * 26> found;
  std::uint32_t count = 0, i = 0;
  for (unsigned left = parents.occupancy[n]; left != 0; left &= left - 1, ++i) {
    if (rows != nullptr && rows[i + 1] - rows[i] == 1) continue;
    const auto child = static_cast<unsigned>(std::countr_zero(left));
    const unsigned corner = (child & 1) + 4 * (child >> 1 & 1) + 16 * (child >> 2);
    std::uint32_t directions = directions_of(window.occupied >> corner & kAllAround);
    around[i] = {directions, first + count};
    for (; directions != 0; directions &= directions - 1) {
      const auto d = static_cast<std::size_t>(std::countr_zero(directions));
      const ChildNeighbour at = kChildNeighbours[child][d];
      found[count++] = window.node[at.node][at.child];
    }
  }
  neighbours.insert(neighbours.end(), found.data(), found.data() + count);
}

}  // namespace

OctreeLevel octree_level(std::span<const std::uint64_t> cells, int level) {
  OctreeLevel nodes = octree_root();
  for (int l = 0; l < level; ++l) {
    const int below = 3 * (level - l - 1);
    std::size_t n = 0;
    for (const std::uint64_t cell : cells) {
      while (nodes.morton[n] != cell >> below >> 3) ++n;
      nodes.occupancy[n] =
          static_cast<std::uint8_t>(nodes.occupancy[n] | 1u << (cell >> below & 7));
    }
    nodes = octree_children(nodes, true);
  }
  return nodes;
}

SLF_MULTIVERSION_ALL
OctreeLevel octree_children(OctreeLevel& parents, bool with_neighbours,
                            std::span<const std::uint32_t> rows) {
  OctreeLevel children;
  std::uint32_t count = 0;
  parents.first_child.resize(parents.size());
  for (std::size_t n = 0; n < parents.size(); ++n) {
    parents.first_child[n] = count;
    count += static_cast<std::uint32_t>(std::popcount(parents.occupancy[n]));
  }
  children.morton.reserve(count);
  for (std::size_t n = 0; n < parents.size(); ++n)
    for (unsigned left = parents.occupancy[n]; left != 0; left &= left - 1)
      children.morton.push_back(parents.morton[n] << 3 |
                                static_cast<unsigned>(std::countr_zero(left)));
  children.occupancy.assign(count, 0);
  if (!with_neighbours) return children;

  children.around.resize(count);
  children.neighbours.reserve(std::size_t{8} * count);  // what a surface has, about
  for (std::size_t n = 0; n < parents.size(); ++n) {
    const std::size_t child = parents.first_child[n];
    const auto end = child + static_cast<std::size_t>(std::popcount(parents.occupancy[n]));
    if (child == end || (!rows.empty() && rows[end] - rows[child] == 1)) continue;
    add_neighbours(parents, n, rows.empty() ? nullptr : &rows[child], &children.around[child],
                   children.neighbours);
  }
  return children;
}

}  // namespace slf
