// SPDX-License-Identifier: Apache-2.0
#include "capture/mesh_triangles.h"

#include <algorithm>

namespace slf {

Corners corners_of(const Mesh& mesh, std::size_t triangle) {
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i)
    corners[i] = to_double(mesh.vertices.positions[mesh.triangles[triangle][i]]);
  return corners;
}

Box bounding_box(const Mesh& mesh) {
  Box box;
  bool first = true;
  const auto add = [&](const std::array<float, 3>& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      box.min[k] = first ? double{p[k]} : std::min(box.min[k], double{p[k]});
      box.max[k] = first ? double{p[k]} : std::max(box.max[k], double{p[k]});
    }
    first = false;
  };
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle) add(mesh.vertices.positions[v]);
  if (mesh.triangles.empty())
    for (const auto& p : mesh.vertices.positions) add(p);
  return box;
}

double sampled_area(const Mesh& mesh) {
  double area = 0;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Corners c = corners_of(mesh, f);
    const Vec3 n = cross(minus(c[1], c[0]), minus(c[2], c[0]));
    area += std::max({std::abs(n[0]), std::abs(n[1]), std::abs(n[2])}) / 2;
  }
  return area;
}

PointCloud triangle_centres(const Mesh& mesh, std::size_t count) {
  PointCloud cloud;
  const std::size_t all = mesh.triangles.size();
  const std::size_t stride =
      std::max<std::size_t>((all + count - 1) / std::max<std::size_t>(count, 1), 1);
  for (std::size_t f = 0; f < all; f += stride) {
    const Corners c = corners_of(mesh, f);
    const auto normal = normal_of(c);
    if (!normal) continue;
    cloud.positions.push_back(
        to_float({(c[0][0] + c[1][0] + c[2][0]) / 3, (c[0][1] + c[1][1] + c[2][1]) / 3,
                  (c[0][2] + c[1][2] + c[2][2]) / 3}));
    cloud.normals.push_back(to_float(*normal));
  }
  return cloud;
}

}  // namespace slf
