// SPDX-License-Identifier: Apache-2.0
// What a frame decoded before has where the children of a node were then. Spec 8.12.3.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "geometry/motion.h"
#include "geometry/node_view.h"
#include "geometry/reference_cells.h"
#include "geometry/reference_walk.h"

namespace slf {

/// A frame decoded before, and how points came from there.
struct MovedReference {
  const ReferenceCells& cells;
  const Motion& motion;
  int bits;  ///< of the grid

  /// How far away was what is at the centre of a node of `level`, in sixteenths of a voxel.
  Displacement at(const Voxel& node, int level) const {
    const int below = bits - level;
    return motion.at(
        {(2 * node[0] + 1) << below, (2 * node[1] + 1) << below, (2 * node[2] + 1) << below}, bits);
  }
};

struct ReferenceView {
  Window cells = 0;        ///< that the window around the node shows there
  unsigned children = 0;   ///< of the node, as an occupancy
  unsigned agreement = 4;  ///< of what is known around the node: 0: all .. 3: little; 4: nothing is

  /// The 3 x 3 x 3 cells around a child.
  Window around(unsigned child) const {
    const unsigned base = (child & 1) + 4 * (child >> 1 & 1) + 16 * (child >> 2);
    return cells >> base & (kAllAround | bit_at(1, 1, 1));
  }
  /// How much of the child's place is occupied, 0 .. 16, linear between the cells' centres.
  unsigned density(unsigned child) const {
    const Window a = around(child);
    unsigned sum = 0;
    for (std::size_t i = 0; i < 8; ++i) sum += (a >> corner[i] & 1) != 0 ? weight[i] : 0;
    return sum >> 5;
  }
  std::array<std::uint8_t, 8> corner{};   ///< bits of the cells around
  std::array<std::uint16_t, 8> weight{};  ///< of 512
};

/// view: of a node of the level. walk: of the level below
inline ReferenceView reference_view(const MovedReference& reference, ReferenceWalk& walk,
                                    std::uint32_t level, const NodeView& view) {
  const Displacement moved = reference.at(view.cell, static_cast<int>(level));
  const int child_log2 = reference.bits - static_cast<int>(level) - 1 + 4;  // sixteenths
  Voxel first;
  std::array<int, 3> beyond{};  // what rounding leaves, in eighths of a cell
  for (std::size_t i = 0; i < 3; ++i) {
    const int whole = (moved[i] + (1 << (child_log2 - 1))) >> child_log2;
    first[i] = 2 * view.cell[i] - 1 + whole;
    beyond[i] = (moved[i] - whole * (1 << child_log2)) >> (child_log2 - 3);
  }
  ReferenceView there;
  for (unsigned i = 0; i < 8; ++i) {
    unsigned bit = 0, weight = 1;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const int by = beyond[axis], far = by < 0 ? -by : by;
      const bool other = (i >> axis & 1) != 0;
      bit += static_cast<unsigned>(1 + (other ? (by < 0 ? -1 : 1) : 0)) << (2 * axis);
      weight *= static_cast<unsigned>(other ? far : 8 - far);
    }
    there.corner[i] = static_cast<std::uint8_t>(bit);
    there.weight[i] = static_cast<std::uint16_t>(weight);
  }
  there.cells = walk.window(first);
  for (int c = 0; c < 8; ++c)
    there.children |= static_cast<unsigned>((there.cells & own_cell(c)) != 0) << c;
  const Window known = ~(view.unknown | kOwnCells[255]);
  const int right = std::popcount(view.occupied & there.cells & known),
            wrong = std::popcount((view.occupied ^ there.cells) & known);
  if (right + wrong > 0)
    there.agreement = wrong == 0 ? 0 : 4 * wrong <= right ? 1 : wrong <= right ? 2 : 3;
  return there;
}

}  // namespace slf
