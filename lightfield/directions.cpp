// SPDX-License-Identifier: Apache-2.0
#include "lightfield/directions.h"

#include "geometry/surface_normals.h"

namespace slf {

std::vector<std::array<float, 3>> mirror_normals(Directions directions,
                                                 std::span<const Voxel> positions, int cell_log2,
                                                 int threads) {
  std::vector<std::array<float, 3>> normals;
  if (directions == Directions::kWorld) return normals;
  normals.reserve(positions.size());
  for (const auto& n : surface_normals(positions, cell_log2, threads)) {
    const double x = static_cast<double>(n[0]), y = static_cast<double>(n[1]),
                 z = static_cast<double>(n[2]);
    const double length = std::sqrt(x * x + y * y + z * z);
    normals.push_back({static_cast<float>(x / length), static_cast<float>(y / length),
                       static_cast<float>(z / length)});
  }
  return normals;
}

}  // namespace slf
