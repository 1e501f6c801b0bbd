// SPDX-License-Identifier: Apache-2.0
#include "geometry/moved_points.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "geometry/morton.h"

namespace slf {

Voxel carried(const Motion& motion, const Voxel& point, int bits) {
  const Displacement moved =
      motion.at({2 * point[0] + 1, 2 * point[1] + 1, 2 * point[2] + 1}, bits);
  Voxel at;
  for (std::size_t i = 0; i < 3; ++i) at[i] = point[i] + ((moved[i] + 8) >> 4);
  return at;
}

MovedPoints move_points(std::span<const std::uint64_t> codes, std::span<const PointMove> moves,
                        const Motion& motion, int bits) {
  const std::int32_t last = (1 << bits) - 1;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  order.reserve(codes.size());
  for (std::size_t p = 0; p < codes.size(); ++p) {
    Voxel at = carried(motion, from_morton(codes[p]), bits);
    for (std::size_t i = 0; i < 3; ++i) at[i] = std::clamp(at[i] + moves[p][i], 0, last);
    order.emplace_back(morton(at), static_cast<std::uint32_t>(p));
  }
  std::sort(order.begin(), order.end());
  MovedPoints moved;
  moved.codes.reserve(order.size());
  moved.from.reserve(order.size());
  for (const auto& [code, p] : order) {
    moved.codes.push_back(code);
    moved.from.push_back(p);
  }
  return moved;
}

}  // namespace slf
