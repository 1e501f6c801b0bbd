#include "geometry/occupancy_history.h"

#include <algorithm>

#include "geometry/morton.h"

namespace slf {
namespace {

constexpr int kSlotBits = 18;

std::size_t slot_of(std::uint32_t a) { return a & ((1u << kSlotBits) - 1); }

std::size_t slot_of(std::uint32_t a, std::uint32_t b, int level) {
  if (2 * level <= kSlotBits) return a | b << level;
  return (a * 2654435761u ^ b * 2246822519u) >> (32 - kSlotBits);
}

}  // namespace

void OccupancyHistory::start_level(int level) {
  level_ = level;
  for (std::size_t i = 0; i < 6; ++i)
    latest_[i].assign(std::size_t{1} << std::min(i < 3 ? level : 2 * level, kSlotBits), 0);
}

std::array<std::uint8_t, 6> OccupancyHistory::at(std::uint64_t morton) {
  const Voxel cell = from_morton(morton);
  const auto x = static_cast<std::uint32_t>(cell[0]), y = static_cast<std::uint32_t>(cell[1]),
             z = static_cast<std::uint32_t>(cell[2]);
  slot_ = {
      slot_of(x),           slot_of(y), slot_of(z), slot_of(y, z, level_), slot_of(x, z, level_),
      slot_of(x, y, level_)};
  std::array<std::uint8_t, 6> occupancy;
  for (std::size_t i = 0; i < 6; ++i) occupancy[i] = latest_[i][slot_[i]];
  return occupancy;
}

void OccupancyHistory::store(std::uint8_t occupancy) {
  for (std::size_t i = 0; i < 6; ++i) latest_[i][slot_[i]] = occupancy;
}

}  // namespace slf
