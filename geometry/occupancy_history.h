// What earlier nodes of a level that share a coordinate, or two, looked like. Spec 8.4.3.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace slf {

/// Scanned and lattice-like clouds repeat along rows and columns much farther apart than
/// neighbours.
class OccupancyHistory {
 public:
  void start_level(int level);

  /// Occupancy of the latest coded node in the same slot, by key: x, y, z, (y, z), (x, z), (x, y).
  /// 0: none yet.
  std::array<std::uint8_t, 6> at(std::uint64_t morton);

  /// Sets all six slots of the node last asked for.
  void store(std::uint8_t occupancy);

 private:
  std::array<std::vector<std::uint8_t>, 6> latest_;
  std::array<std::size_t, 6> slot_{};
  int level_ = 0;
};

}  // namespace slf
