// Which coefficients lie around a coefficient, and how large it is likely to be beside them. Spec
// 8.7.2.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "attributes/raht_tree.h"

namespace slf {

/// What contexts need to know of the rows of a tree; the same for all planes.
struct CoefficientNeighbours {
  /// [P] rows of the merges of the same split beside row's towards lower x, y, z; 0 for none. They
  /// are coded before it.
  std::vector<std::array<std::uint32_t, 3>> faces;
  /// [P] sqrt(l r / (l + r)) for a merge of nodes of l and r points, 8 fractional bits: what the
  /// coefficient is for a difference of 1 between the nodes' means.
  std::vector<std::uint32_t> scale;
};

/// @param morton  codes of the points, ascending
/// @param first   [rows + 1] first point of each row of the tree, and the number of points
/// O(P) time on average.
CoefficientNeighbours find_coefficient_neighbours(const RahtTree& tree,
                                                  std::span<const std::uint64_t> morton,
                                                  std::span<const std::uint32_t> first);

}  // namespace slf
