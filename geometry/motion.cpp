// SPDX-License-Identifier: Apache-2.0
#include "geometry/motion.h"

#include <algorithm>
#include <cstddef>

namespace slf {

void Motion::add_lattice(const std::array<std::int32_t, 3>& place,
                         std::array<std::int64_t, 3>& sum) const {
  const int side = lattice_log2 + 1;  // in halves of a voxel
  std::array<std::int64_t, 3> cell{}, in{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t from = place[i] - (std::int64_t{lattice_first[i]} << side);
    const std::int64_t last = (std::int64_t{lattice_size[i]} - 1) << side;
    const std::int64_t inside = std::clamp(from, std::int64_t{0}, last);
    cell[i] =
        std::min(inside >> side, std::max(std::int64_t{lattice_size[i]} - 2, std::int64_t{0}));
    in[i] = inside - (cell[i] << side);
  }
  std::array<std::int64_t, 3> added{};
  for (int corner = 0; corner < 8; ++corner) {
    std::int64_t weight = 1;
    std::size_t index = 0;
    for (std::size_t i = 3; i-- > 0;) {
      const bool upper = (corner >> i & 1) != 0;
      weight *= upper ? in[i] : (std::int64_t{1} << side) - in[i];
      index = index * static_cast<std::size_t>(lattice_size[i]) +
              static_cast<std::size_t>(cell[i] + upper);
    }
    if (weight == 0) continue;
    for (std::size_t i = 0; i < 3; ++i) added[i] += weight * lattice[index][i];
  }
  const std::int64_t half = std::int64_t{1} << (3 * side - 1);
  for (std::size_t i = 0; i < 3; ++i) sum[i] += (added[i] + half) >> (3 * side);
}

}  // namespace slf
