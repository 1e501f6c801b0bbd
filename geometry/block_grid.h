// SPDX-License-Identifier: Apache-2.0
// The points of a slice by blocks of 4 x 4 x 4 cells, with neighbours. Spec 8.11.1.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/octree_levels.h"

namespace slf {

/// Finds the point in a cell in constant time, with memory for occupied blocks alone: 120 bytes a
/// block, which is no more than the octree of the geometry took.
class BlockGrid {
 public:
  /// morton: of the points, distinct, ascending, of a cube of side 2^depth. O(P * depth).
  BlockGrid(std::span<const std::uint64_t> morton, int depth);

  struct Block {
    std::uint64_t cells = 0;  ///< bit i: the cell of Morton code i within the block holds a point
    std::uint32_t first = 0;  ///< index of its first point
  };

  std::size_t size() const { return blocks_.size(); }
  const Block& block(std::size_t b) const { return blocks_[b]; }
  using Neighbours = std::array<std::int32_t, 27>;
  /// By direction (8.4.1): index of the block there, -1 where it is empty.
  const Neighbours& neighbours(std::size_t b) const { return neighbours_[b]; }
  std::uint32_t block_of(std::size_t point) const { return block_of_[point]; }

  /// Index of the point in the cell in direction d of point i, -1 where there is none.
  std::int64_t neighbour(std::size_t i, std::uint64_t code, std::size_t d) const;

 private:
  std::vector<Block> blocks_;
  std::vector<Neighbours> neighbours_;
  std::vector<std::uint32_t> block_of_;  // [P]
};

}  // namespace slf
