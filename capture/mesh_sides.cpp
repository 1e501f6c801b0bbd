// SPDX-License-Identifier: Apache-2.0
#include "capture/mesh_sides.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "capture/mesh_sampling.h"
#include "capture/mesh_triangles.h"
#include "capture/nearest.h"
#include "capture/normal_orientation.h"
#include "capture/quantile.h"
#include "slf/parallel.h"

namespace slf {

namespace {

constexpr int kSurveyBits = 6;  // of the sample that tells inside from outside
constexpr std::size_t kSurveyCameras = 32;
constexpr std::size_t kSurveyPoints = 20000;
constexpr double kOutermost = 0.01;  // of the points, along each axis and to each side
constexpr double kManyAway = 0.25;   // of points in front

void add_in_front(const Camera& camera, const PointCloud& points, double tolerance, Sides& sides) {
  struct Seen {
    double u, v, depth;
    std::size_t point;
  };
  std::vector<Seen> seen;
  double u0 = camera.width, u1 = 0, v0 = camera.height, v1 = 0;
  for (std::size_t p = 0; p < points.positions.size(); ++p) {
    double depth = 0;
    const auto at = camera.project(to_double(points.positions[p]), &depth);
    if (!at || !((*at)[0] >= 0 && (*at)[1] >= 0) || (*at)[0] > camera.width ||
        (*at)[1] > camera.height)
      continue;
    seen.push_back({(*at)[0], (*at)[1], depth, p});
    u0 = std::min(u0, (*at)[0]);
    u1 = std::max(u1, (*at)[0]);
    v0 = std::min(v0, (*at)[1]);
    v1 = std::max(v1, (*at)[1]);
  }
  constexpr std::size_t kSide = 32;  // cells, each wider than the points are apart
  const double cell = std::max({u1 - u0, v1 - v0, 1e-9}) / (kSide - 1);
  std::vector<double> nearest(kSide * kSide, std::numeric_limits<double>::infinity());
  const auto cell_of = [&](const Seen& s) {
    return static_cast<std::size_t>((s.v - v0) / cell) * kSide +
           static_cast<std::size_t>((s.u - u0) / cell);
  };
  for (const Seen& s : seen) nearest[cell_of(s)] = std::min(nearest[cell_of(s)], s.depth);
  const Vec3 centre = camera.centre();
  for (const Seen& s : seen) {
    if (s.depth > nearest[cell_of(s)] + tolerance) continue;
    const double cosine = dot(minus(centre, to_double(points.positions[s.point])),
                              to_double(points.normals[s.point]));
    sides.towards += cosine > 0;
    sides.away += cosine < 0;
  }
}

/// Some of the points, without the outermost: structure from motion has points far away, and cells
/// and tolerances as wide as these tell nothing.
PointCloud some_of(const PointCloud& cloud) {
  PointCloud some;
  const std::size_t stride = std::max<std::size_t>(cloud.positions.size() / kSurveyPoints, 1);
  std::array<float, 3> low{}, high{};
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<float> values;
    for (std::size_t p = 0; p < cloud.positions.size(); p += stride)
      values.push_back(cloud.positions[p][k]);
    low[k] = quantile(values, kOutermost);
    high[k] = quantile(values, 1 - kOutermost);
  }
  for (std::size_t p = 0; p < cloud.positions.size(); p += stride) {
    const auto& at = cloud.positions[p];
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k) inside = inside && at[k] >= low[k] && at[k] <= high[k];
    if (!inside) continue;
    some.positions.push_back(at);
    some.normals.push_back(cloud.normals[p]);
  }
  return some;
}

double largest_side(const PointCloud& cloud) {
  double side = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [low, high] =
        std::minmax_element(cloud.positions.begin(), cloud.positions.end(),
                            [k](const auto& a, const auto& b) { return a[k] < b[k]; });
    side = std::max(side, double{(*high)[k]} - double{(*low)[k]});
  }
  return side;
}

/// As estimate_normals turns those that it made.
void turn_each(std::span<const Vec3> viewpoints, PointCloud& cloud) {
  const std::size_t count = cloud.positions.size();
  const std::size_t near = std::min<std::size_t>(count, 16);
  const NearestPoints tree(cloud.positions);
  std::vector<std::uint32_t> neighbours(count * near);
  parallel_ranges(count, 1024, 0, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      tree.nearest(cloud.positions[i], static_cast<int>(near), &neighbours[i * near], nullptr);
  });
  orient_towards(cloud.positions, viewpoints, neighbours, 0, cloud.normals);
}

}  // namespace

Sides sides_in_front(const std::vector<Camera>& cameras, const PointCloud& points,
                     double tolerance) {
  Sides sides;
  const std::size_t chosen = std::min(cameras.size(), kSurveyCameras);
  for (std::size_t c = 0; c < chosen; ++c)
    add_in_front(cameras[c * cameras.size() / chosen], points, tolerance, sides);
  return sides;
}

GivenNormals turn_towards(const std::vector<Camera>& cameras, PointCloud& cloud) {
  if (cloud.normals.empty() || cloud.positions.empty()) return GivenNormals::kOutwards;
  const PointCloud some = some_of(cloud);
  if (some.positions.empty()) return GivenNormals::kOutwards;
  const Sides sides =
      sides_in_front(cameras, some, 2 * largest_side(some) / ((1 << kSurveyBits) - 1));
  if (static_cast<double>(sides.away) <=
      kManyAway * static_cast<double>(sides.towards + sides.away))
    return GivenNormals::kOutwards;
  // The survey sees through to the other side of thin parts; all points are asked now.
  std::vector<Vec3> viewpoints;
  for (const Camera& camera : cameras) viewpoints.push_back(camera.centre());
  const double share = share_facing_away(cloud.positions, viewpoints, cloud.normals, 0);
  if (share <= kManyAway) return GivenNormals::kOutwards;
  if (share < 1 - kManyAway) {
    turn_each(viewpoints, cloud);
    return GivenNormals::kEitherWay;
  }
  for (auto& normal : cloud.normals)
    for (float& n : normal) n = -n;
  return GivenNormals::kInwards;
}

bool turn_towards(const std::vector<Camera>& cameras, Mesh& mesh) {
  const auto grid = choose_grid(bounding_box(mesh), 1, kSurveyBits, 0);
  if (!grid) return false;
  const auto points = sample_mesh(mesh, *grid);
  if (!points) return false;
  const Sides sides = sides_in_front(cameras, *points, 2 * grid->step);
  if (sides.towards >= sides.away) return false;
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  for (auto& normal : mesh.vertices.normals)
    for (float& n : normal) n = -n;
  return true;
}

}  // namespace slf
