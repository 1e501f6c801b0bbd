// SPDX-License-Identifier: Apache-2.0
#include "geometry/occupancy_history.h"

#include <algorithm>

namespace slf {

void OccupancyHistory::start_level(int level) {
  level_ = level;
  const std::size_t slots = std::size_t{1} << std::min(2 * level, kSlotBits);
  for (auto& latest : latest_)
    if (latest.size() < slots) latest.resize(slots);
}

/// Slices of few points have levels of few nodes: the work is theirs, not that of the tables.
void OccupancyHistory::finish_level(std::span<const std::uint64_t> cells) {
  constexpr std::size_t kCellCost = 16;  // bytes filled in the time of a cell
  const std::size_t slots = std::size_t{1} << std::min(2 * level_, kSlotBits);
  if (cells.size() * kCellCost < slots) {
    for (const std::uint64_t cell : cells) {
      at(from_morton(cell));
      store(0);
    }
  } else {
    for (auto& latest : latest_) std::fill_n(latest.begin(), slots, std::uint8_t{0});
  }
}

}  // namespace slf
