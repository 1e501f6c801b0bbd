// SPDX-License-Identifier: Apache-2.0
// The octree blocks that hold points, from the finest up to the one that holds all, and what is
// between them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "slf/types.h"

namespace slf {

/// The blocks of one level around a place, and what each of them counts there.
struct BlockBlend {
  std::size_t count = 0;  ///< 1 .. 8
  std::array<std::size_t, 8> block{};
  std::array<float, 8> weight{};  ///< of sum 1
};

/// Level 0 has the finest blocks. Blocks of a level come in Morton order.
class BlockTree {
 public:
  /// @param positions   Morton order, at least one
  /// @param block_log2  side of the finest blocks
  BlockTree(std::span<const Voxel> positions, int block_log2);

  std::size_t levels() const { return codes_.size(); }
  std::size_t blocks(std::size_t level) const { return codes_[level].size(); }
  /// Block b has points, or blocks of the finer level, first(level, b) .. first(level, b + 1) - 1.
  std::size_t first(std::size_t level, std::size_t b) const { return first_[level][b]; }

  /// Finest blocks around a point of the tree. The weight of a block falls linearly with the
  /// distance to its middle along each axis and is 0 at the middle of the next one, so that what is
  /// interpolated between blocks has no step where a block ends. Blocks without points do not
  /// count. O(log blocks).
  BlockBlend around(const Voxel& point) const { return between(0, point, block_log2_); }
  /// The same of the level above, around the middle of block b of `level`, which is not the last.
  BlockBlend above(std::size_t level, std::size_t b) const;

 private:
  BlockBlend between(std::size_t level, const Voxel& place, int side_log2) const;

  int block_log2_;
  std::vector<std::vector<std::size_t>> first_;    // [levels][blocks + 1]
  std::vector<std::vector<std::uint64_t>> codes_;  // [levels][blocks] Morton codes
};

}  // namespace slf
