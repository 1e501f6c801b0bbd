// SPDX-License-Identifier: Apache-2.0
#include "geometry/occupancy_slabs.h"

#include <algorithm>

namespace slf {

/// Slices of few points have levels of few nodes: the work is theirs, not that of the tables.
void OccupancySlabs::finish_level(std::span<const std::uint64_t> cells, int level) {
  constexpr std::size_t kCellCost = 32;  // contexts filled in the time of a cell
  const std::size_t slots = level + 1 < 12 ? std::size_t{2} << level : kSlots;
  if (cells.size() * kCellCost < slots) {
    for (const std::uint64_t code : cells) {
      const Voxel cell = from_morton(code);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        only_[axis][slot(cell[axis])] = {};
        halves_[axis][slot(2 * cell[axis])] = halves_[axis][slot(2 * cell[axis] + 1)] = {};
      }
    }
  } else {
    for (auto* tables : {&only_, &halves_})
      for (Contexts& contexts : *tables) std::fill_n(contexts.begin(), slots, ContextBit{});
  }
}

}  // namespace slf
