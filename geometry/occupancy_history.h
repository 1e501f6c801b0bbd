// SPDX-License-Identifier: Apache-2.0
// What earlier nodes of a level that share two coordinates looked like. Spec 8.4.3.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/morton.h"

namespace slf {

/// Scanned and lattice-like clouds repeat along columns much farther apart than
/// neighbours.
class OccupancyHistory {
 public:
  void start_level(int level);
  /// cells: of the level, all stored; leaves the slots empty.
  void finish_level(std::span<const std::uint64_t> cells);

  /// Occupancy of the latest coded node in the same slot, by key: (y, z), (x, z), (x, y).
  /// 0: none yet.
  std::array<std::uint8_t, 3> at(const Voxel& cell) {
    const auto x = static_cast<std::uint32_t>(cell[0]), y = static_cast<std::uint32_t>(cell[1]),
               z = static_cast<std::uint32_t>(cell[2]);
    slot_ = {slot_of(y, z), slot_of(x, z), slot_of(x, y)};
    std::array<std::uint8_t, 3> occupancy;
    for (std::size_t i = 0; i < 3; ++i) occupancy[i] = latest_[i][slot_[i]];
    return occupancy;
  }

  /// Sets all slots of the node last asked for.
  void store(std::uint8_t occupancy) {
    for (std::size_t i = 0; i < 3; ++i) latest_[i][slot_[i]] = occupancy;
  }

 private:
  static constexpr int kSlotBits = 18;

  std::size_t slot_of(std::uint32_t a, std::uint32_t b) const {
    if (2 * level_ <= kSlotBits) return a | b << level_;
    return (a * 2654435761u ^ b * 2246822519u) >> (32 - kSlotBits);
  }

  std::array<std::vector<std::uint8_t>, 3> latest_;  // all 0 between levels
  std::array<std::size_t, 3> slot_{};
  int level_ = 0;
};

}  // namespace slf
