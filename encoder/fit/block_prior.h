// SPDX-License-Identifier: Apache-2.0
// What the surface around a point says about its view map: one solution per octree block, each
// shrunk towards those of the blocks above it, and between blocks what is interpolated.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/release.h"
#include "encoder/fit/block_tree.h"
#include "slf/types.h"

namespace slf {

/// What was seen of one point from M directions.
struct PointColumns {
  std::size_t count = 0;         ///< M, at least 1
  std::size_t stride = 0;        ///< M, up to whole lanes; what is behind M is of no meaning
  std::vector<float> functions;  ///< [K][stride] of mean square 1; [0] is 1
  std::vector<float> colours;    ///< [3][stride]
};

/// Pooled normal equations of the blocks of a tree, in which every point keeps a mean colour of its
/// own: rows and colours are taken less their means over the point.
class BlockPrior {
 public:
  /// @param positions   Morton order, at least one
  /// @param block_log2  side of the finest blocks
  BlockPrior(std::span<const Voxel> positions, int block_log2, std::size_t functions);

  const BlockTree& tree() const { return tree_; }

  /// Adds what was seen of a point of finest block b. Blocks may be filled in parallel.
  void add(std::size_t b, const PointColumns& seen);
  /// Sums of the coarser blocks; after all points were added.
  void sum_up(int threads);

  /// Solves from the root down: in each block the excess over x, interpolated at its middle between
  /// the solutions of the level above, of least
  ///     |c - G (x + e)|^2 + sum_k strength * n * penalty_k e_k^2,   n observations in the block.
  /// @param penalty  [K], > 0 but for element 0, which is not used
  /// @return [finest blocks][K][3]; element 0 of each is 0
  std::vector<float> solve(double strength, std::span<const double> penalty, int threads) const;

  /// Gives the sums up; solve() must not be called after it.
  void forget_sums() { release(sums_); }

 private:
  /// Sums of the blocks of a level. Colours are three more functions: their products with those are
  /// the right-hand sides.
  struct LevelSums {
    std::vector<float> matrix;  // [blocks][width_][width_], lower triangle; row and column 0 are 0
    std::vector<double> observations;  // [blocks]
  };
  using Solution = std::vector<double>;  // [K][3]
  Solution from_above(std::size_t level, std::size_t b, std::span<const Solution> above) const;
  Solution solve_block(std::size_t level, std::size_t b, Solution above,
                       std::span<const double> penalty) const;
  float* matrix_of(std::size_t level, std::size_t b) {
    return sums_[level].matrix.data() + b * width_ * width_;
  }

  BlockTree tree_;
  std::size_t functions_;        // K
  std::size_t width_;            // K + 3, up to whole lanes
  std::vector<LevelSums> sums_;  // [levels]
};

}  // namespace slf
