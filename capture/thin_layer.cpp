// SPDX-License-Identifier: Apache-2.0
#include "capture/thin_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "capture/keep_marked.h"
#include "geometry/morton.h"

namespace slf {

namespace {

std::size_t main_axis(const std::array<float, 3>& normal) {
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
  return axis;
}

/// Voxels by place. Positions are in Morton order.
class VoxelIndex {
 public:
  explicit VoxelIndex(const VoxelCloud& voxels) {
    for (const Voxel& v : voxels.positions) codes_.push_back(morton(v));
  }

  std::optional<std::size_t> find(std::uint64_t code) const {
    const auto at = std::lower_bound(codes_.begin(), codes_.end(), code);
    if (at == codes_.end() || *at != code) return std::nullopt;
    return static_cast<std::size_t>(at - codes_.begin());
  }

 private:
  std::vector<std::uint64_t> codes_;
};

/// [voxels] distance from the middle of the voxel's column to the nearest point in it; voxels.
std::vector<float> distances_to_middle(const PointCloud& cloud, const VoxelCloud& voxels,
                                       const VoxelIndex& index) {
  const Grid& grid = voxels.grid;
  const double last = double((1 << grid.bits) - 1);
  std::vector<float> distance(voxels.positions.size(), std::numeric_limits<float>::infinity());
  for (const auto& p : cloud.positions) {
    Voxel voxel{};
    Vec3 off{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = (double{p[k]} - grid.origin[k]) / grid.step;
      const double cell = std::clamp(std::floor(x + 0.5), 0.0, last);
      voxel[k] = static_cast<std::int32_t>(cell);
      off[k] = std::abs(x - cell);
    }
    const auto at = index.find(morton(voxel));
    if (!at) continue;
    const std::size_t axis = main_axis(voxels.normals[*at]);
    const double aside = std::max(off[(axis + 1) % 3], off[(axis + 2) % 3]);
    distance[*at] = std::min(distance[*at], static_cast<float>(aside));
  }
  return distance;
}

}  // namespace

void thin_layer(const PointCloud& cloud, VoxelCloud& voxels) {
  const VoxelIndex index(voxels);
  const auto distance = distances_to_middle(cloud, voxels, index);
  const int last = (1 << voxels.grid.bits) - 1;
  std::vector<bool> kept(voxels.positions.size(), true);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const std::size_t axis = main_axis(voxels.normals[i]);
    for (const int step : {-1, 1}) {
      Voxel beside = voxels.positions[i];
      beside[axis] += step;
      if (beside[axis] < 0 || beside[axis] > last) continue;
      const auto other = index.find(morton(beside));
      if (!other || main_axis(voxels.normals[*other]) != axis) continue;
      // Two sides of a thin sheet are two layers.
      float facing = 0;
      for (std::size_t k = 0; k < 3; ++k)
        facing += voxels.normals[i][k] * voxels.normals[*other][k];
      if (facing <= 0) continue;
      const bool better =
          distance[*other] != distance[i] ? distance[*other] < distance[i] : *other < i;
      if (better) kept[i] = false;
    }
  }
  keep_marked(voxels.positions, kept);
  keep_marked(voxels.normals, kept);
  keep_marked(voxels.colours, kept);
  voxels.merged = cloud.positions.size() - voxels.positions.size();
}

}  // namespace slf
