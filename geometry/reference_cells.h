// SPDX-License-Identifier: Apache-2.0
// Where a frame that was decoded before has points: at any level, at any place. Spec 8.12.2.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/occupancy_window.h"
#include "slf/types.h"

namespace slf {

/// 4 x 4 x 4 cells of a level.
struct ReferenceBrick {
  std::uint64_t key = 0;     ///< 1 + code of the brick; 0: no cell is there
  Window cells = 0;          ///< as a window has them
  std::uint64_t morton = 0;  ///< the same in Morton order
  std::uint32_t first = 0;   ///< place of its first cell
};

/// The cells of one level in bricks.
class ReferenceLevel {
 public:
  /// @param codes  of the cells at the level: distinct, ascending
  explicit ReferenceLevel(std::span<const std::uint64_t> codes);

  static constexpr std::uint32_t kNone = ~0u;  ///< the place of a cell that is empty

  /// at: in bricks; it may lie outside of the grid, where no cell is
  const ReferenceBrick& brick(const Voxel& at) const;
  std::uint64_t bytes() const { return table_.size() * sizeof(ReferenceBrick); }  ///< of memory

 private:
  std::vector<ReferenceBrick> table_;  // open addressing, a power of two, at most half full
  int shift_;
};

/// All levels of a frame.
class ReferenceCells {
 public:
  ReferenceCells() = default;
  /// @param codes  of the points, distinct, ascending, of `bits` levels
  ReferenceCells(std::span<const std::uint64_t> codes, int bits);

  /// Nodes of level 0 .. bits.
  const ReferenceLevel& level(int level) const { return levels_[static_cast<std::size_t>(level)]; }
  std::span<const std::uint64_t> codes(int level) const {
    return codes_[static_cast<std::size_t>(level)];
  }
  bool empty() const { return levels_.empty(); }
  /// Are the nodes of the level known?
  bool has(int level) const { return level < static_cast<int>(levels_.size()); }
  /// How many levels the grid has; -1: no cell is known.
  int levels() const { return static_cast<int>(levels_.size()) - 1; }
  std::uint64_t bytes() const;  ///< of memory

 private:
  std::vector<std::vector<std::uint64_t>> codes_;
  std::vector<ReferenceLevel> levels_;
};

}  // namespace slf
