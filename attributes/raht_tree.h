// SPDX-License-Identifier: Apache-2.0
// The transform tree over the points of a slice; every plane uses the same. Spec 8.6.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "attributes/code_weights.h"
#include "geometry/isqrt.h"  // of 8.6.2

namespace slf {

/// One merge of two nodes. Rows are points in Morton order; a node's mean lives in the row of its
/// first point, the difference of a merge in the row of the right node's first point. So every row
/// but 0 holds exactly one difference when the transform is done, and row 0 the mean of all.
struct Merge {
  std::uint32_t left, right;      ///< rows
  std::int32_t cos_q30, sin_q30;  ///< sqrt of the left and right share of the weight (spec 8.6.2)
};

struct RahtTree {
  std::vector<Merge> merges;          ///< [P - 1] by octree level, then by node, parents before
                                      ///< children
  std::vector<std::uint8_t> split;    ///< [P] Morton bit that row's merge joins; 255 for row 0
  std::vector<std::uint32_t> parent;  ///< [P] row whose merge is next above row's; 0 at the top
  std::vector<std::uint32_t> order;  ///< [P] rows in coding order: row 0, then by split descending,
                                     ///< rows ascending within a split
  std::size_t size() const { return split.size(); }
};

/// morton: distinct, ascending, at least one, at most 2^22. O(P).
RahtTree build_raht_tree(std::span<const std::uint64_t> morton, const CodeWeights& weights = {});

/// The top of the tree over points: only merges of split >= lowest_split; a row is what they join.
struct RahtTop {
  RahtTree tree;
  std::vector<std::uint32_t> first;  ///< [rows + 1] first point of each row's node, and P
};
/// O(P) time to count, O(rows) for the rest and in memory.
RahtTop build_raht_top(std::span<const std::uint64_t> morton, int lowest_split,
                       const CodeWeights& weights = {});

/// All merges but those that join cells; merges come by level, so these are the last. 0: all.
inline std::span<const Merge> merges_below(const RahtTree& tree, std::size_t cells) {
  return std::span(tree.merges).subspan(cells > 0 ? cells - 1 : 0);
}

/// Position in tree.order of the first row whose split is below `bit`.
std::size_t order_end(const RahtTree& tree, int bit);

/// Position in tree.order of the first row of an octree level, which is joined by the splits
/// 3 (grid_bits - 1 - level) .. + 2; row 0 comes before all levels.
inline std::size_t order_at(const RahtTree& tree, int grid_bits, std::uint32_t level) {
  return level == 0 ? 0 : order_end(tree, 3 * (grid_bits - static_cast<int>(level)));
}

}  // namespace slf
