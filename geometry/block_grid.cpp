// SPDX-License-Identifier: Apache-2.0
#include "geometry/block_grid.h"

#include <bit>
#include <utility>

namespace slf {
namespace {

/// Neighbours of the nodes `codes` (ascending, distinct) of the level `depth` of an octree.
std::vector<BlockGrid::Neighbours> node_neighbours(const std::vector<std::uint64_t>& codes,
                                                   int depth) {
  OctreeLevel level = octree_root();
  for (int below = depth - 1; below >= 0; --below) {  // levels between the children and the blocks
    std::size_t node = 0;
    for (const std::uint64_t code : codes) {
      while (level.morton[node] != code >> (3 * (below + 1))) ++node;
      level.occupancy[node] =
          static_cast<std::uint8_t>(level.occupancy[node] | 1u << (code >> (3 * below) & 7u));
    }
    level = octree_children(level, true);
  }
  std::vector<BlockGrid::Neighbours> neighbours(level.size());
  for (std::size_t n = 0; n < level.size(); ++n)
    for (std::size_t d = 0; d < 27; ++d)
      neighbours[n][d] = d == kSelf ? static_cast<std::int32_t>(n)
                         : level.around[n].directions >> d & 1u
                             ? static_cast<std::int32_t>(level.neighbour(n, d))
                             : -1;
  return neighbours;
}

/// A cell next to one of a block: which block it lies in, by direction, and its code in there.
struct CellNeighbour {
  std::uint8_t block, cell;
};
/// [cell][direction]
constexpr auto kCellNeighbours = [] {
  std::array<std::array<CellNeighbour, 27>, 64> table{};
  const auto bits = [](int v) { return (v & 1) | (v & 2) << 2; };
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x)
        for (int dz = -1; dz <= 1; ++dz)
          for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
              const int nx = x + dx + 4, ny = y + dy + 4, nz = z + dz + 4;  // 3 .. 8
              const int block = direction_index(nx / 4 - 1, ny / 4 - 1, nz / 4 - 1);
              const int cell = bits(nx & 3) | bits(ny & 3) << 1 | bits(nz & 3) << 2;
              table[static_cast<std::size_t>(bits(x) | bits(y) << 1 | bits(z) << 2)]
                   [static_cast<std::size_t>(direction_index(dx, dy, dz))] = {
                       static_cast<std::uint8_t>(block), static_cast<std::uint8_t>(cell)};
            }
  return table;
}();

}  // namespace

BlockGrid::BlockGrid(std::span<const std::uint64_t> morton, int depth) {
  std::vector<std::uint64_t> codes;
  block_of_.reserve(morton.size());
  for (std::size_t i = 0; i < morton.size(); ++i) {
    if (codes.empty() || morton[i] >> 6 != codes.back()) {
      codes.push_back(morton[i] >> 6);
      blocks_.push_back({0, static_cast<std::uint32_t>(i)});
    }
    blocks_.back().cells |= std::uint64_t{1} << (morton[i] & 63);
    block_of_.push_back(static_cast<std::uint32_t>(blocks_.size() - 1));
  }
  neighbours_ = node_neighbours(codes, depth > 2 ? depth - 2 : 0);
}

std::int64_t BlockGrid::neighbour(std::size_t i, std::uint64_t code, std::size_t d) const {
  const CellNeighbour& at = kCellNeighbours[code & 63][d];
  const std::int32_t b = neighbours_[block_of_[i]][at.block];
  if (b < 0) return -1;
  const Block& block = blocks_[static_cast<std::size_t>(b)];
  if (!(block.cells >> at.cell & 1u)) return -1;
  const std::uint64_t before = block.cells & ((std::uint64_t{1} << at.cell) - 1);
  return std::int64_t{block.first} + std::popcount(before);
}

}  // namespace slf
