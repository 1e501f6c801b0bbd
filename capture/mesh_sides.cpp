#include "capture/mesh_sides.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "capture/mesh_sampling.h"
#include "capture/mesh_triangles.h"

namespace slf {

namespace {

constexpr int kSurveyBits = 6;  // of the sample that tells inside from outside
constexpr std::size_t kSurveyCameras = 32;

/// Of the points that a camera sees in front of all others: how many more face it than do not.
/// @param tolerance  depth behind the foremost that still counts as in front
std::ptrdiff_t facing_in_front(const Camera& camera, const PointCloud& points, double tolerance) {
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
  std::ptrdiff_t facing = 0;
  const Vec3 centre = camera.centre();
  for (const Seen& s : seen) {
    if (s.depth > nearest[cell_of(s)] + tolerance) continue;
    const double cosine = dot(minus(centre, to_double(points.positions[s.point])),
                              to_double(points.normals[s.point]));
    facing += (cosine > 0) - (cosine < 0);
  }
  return facing;
}

}  // namespace

bool turn_towards(const std::vector<Camera>& cameras, Mesh& mesh) {
  const auto grid = choose_grid(bounding_box(mesh), 1, kSurveyBits, 0);
  if (!grid) return false;
  const auto points = sample_mesh(mesh, *grid);
  if (!points) return false;
  std::ptrdiff_t facing = 0;
  const std::size_t chosen = std::min(cameras.size(), kSurveyCameras);
  for (std::size_t c = 0; c < chosen; ++c)
    facing += facing_in_front(cameras[c * cameras.size() / chosen], *points, 2 * grid->step);
  if (facing >= 0) return false;
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  for (auto& normal : mesh.vertices.normals)
    for (float& n : normal) n = -n;
  return true;
}

}  // namespace slf
