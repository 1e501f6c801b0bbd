// SPDX-License-Identifier: Apache-2.0
// Which coefficients lie around a coefficient, and how large it is likely to be beside them. Spec
// 8.7.2.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "attributes/raht_tree.h"

namespace slf {

/// What contexts need to know of the rows of a tree; the same for all planes. By place in the
/// coding order, in which rows that are near in the tree are near in memory; place 0, row 0's,
/// stands for none.
struct CoefficientNeighbours {
  struct Row {
    std::uint32_t parent = 0;              ///< whose merge is next above
    std::array<std::uint32_t, 3> faces{};  ///< merges of the same split beside this one's towards
                                           ///< lower x, y, z: coded before it
    /// sqrt(l r / (l + r)) for a merge of nodes of l and r points, 8 fractional bits: what the
    /// coefficient is for a difference of 1 between the nodes' means.
    std::uint32_t scale = 0;
    std::uint32_t split = 0;  ///< RahtTree::split
  };

  std::vector<Row> rows;             ///< [P] by place
  std::vector<std::uint32_t> place;  ///< [P] of a row of the tree
};

/// @param morton  codes of the points, ascending
/// @param first   [rows + 1] first point of each row of the tree, and the number of points
/// @param weights  of the codes
/// O(P) time on average.
CoefficientNeighbours find_coefficient_neighbours(const RahtTree& tree,
                                                  std::span<const std::uint64_t> morton,
                                                  std::span<const std::uint32_t> first,
                                                  const CodeWeights& weights = {});

}  // namespace slf
