// SPDX-License-Identifier: Apache-2.0
#include "capture/plenoptic_order.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "geometry/morton.h"

namespace slf {

void sort_by_voxels(PlenopticCloud& cloud) {
  std::vector<std::uint64_t> codes;
  for (const Voxel& v : cloud.positions) codes.push_back(morton(v));
  std::vector<std::size_t> order(codes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return codes[a] < codes[b]; });
  const auto row = static_cast<std::ptrdiff_t>(3 * cloud.num_colours());
  const auto positions = std::exchange(cloud.positions, {});
  const auto colours = std::exchange(cloud.colours, {});
  for (const std::size_t p : order) {
    cloud.positions.push_back(positions[p]);
    const auto from = colours.begin() + static_cast<std::ptrdiff_t>(p) * row;
    cloud.colours.insert(cloud.colours.end(), from, from + row);
  }
}

}  // namespace slf
