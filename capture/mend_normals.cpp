// SPDX-License-Identifier: Apache-2.0
#include "capture/mend_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "capture/nearest.h"

namespace slf {
namespace {

constexpr int kGivers = 8;
using Normal = std::array<float, 3>;

std::optional<Normal> unit(const Normal& n) {
  const double length = std::hypot(double{n[0]}, double{n[1]}, double{n[2]});
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  return Normal{float(double{n[0]} / length), float(double{n[1]} / length),
                float(double{n[2]} / length)};
}

/// The mean over neighbours, nearest first; the normal of the nearest if they cancel out.
Normal mean_of(const std::vector<Normal>& normals, std::span<const std::uint32_t> neighbours) {
  Normal sum{};
  for (const std::uint32_t i : neighbours)
    for (std::size_t k = 0; k < 3; ++k) sum[k] += normals[i][k];
  return unit(sum).value_or(normals[neighbours[0]]);
}

void take_from_neighbours(PointCloud& cloud, const std::vector<std::size_t>& without) {
  std::vector<Normal> positions, normals;
  std::size_t next = 0;
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    if (next < without.size() && without[next] == i) {
      ++next;
      continue;
    }
    positions.push_back(cloud.positions[i]);
    normals.push_back(cloud.normals[i]);
  }
  const int near = int(std::min<std::size_t>(kGivers, positions.size()));
  const NearestPoints tree(positions);
  std::vector<std::uint32_t> neighbours(std::size_t(near), 0);
  for (const std::size_t i : without) {
    tree.nearest(cloud.positions[i], near, neighbours.data(), nullptr);
    cloud.normals[i] = mean_of(normals, neighbours);
  }
}

}  // namespace

std::size_t mend_normals(Mesh& mesh) {
  PointCloud& cloud = mesh.vertices;
  std::vector<std::size_t> without;
  for (std::size_t i = 0; i < cloud.normals.size(); ++i)
    if (const auto normal = unit(cloud.normals[i]))
      cloud.normals[i] = *normal;
    else
      without.push_back(i);
  if (without.empty()) return 0;
  if (!mesh.triangles.empty() || 2 * without.size() >= cloud.normals.size())
    cloud.normals.clear();
  else
    take_from_neighbours(cloud, without);
  return without.size();
}

}  // namespace slf
