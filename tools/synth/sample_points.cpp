// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/sample_points.h"

#include <unordered_set>

#include "slf/parallel.h"
#include "tools/synth/shading.h"

namespace slf::synth {
namespace {

/// Where the surface turns from one axis to the next, either may just miss a voxel that the other
/// counts on: crossings a little past the turn are kept too, unless their voxel is taken already.
constexpr double kOverlap = 0.88;

/// The largest of the normal's components, and the one along `axis`, both without sign.
struct Lean {
  double largest, along;
};

Lean lean(const Vec3& n, std::size_t axis) {
  return {std::max({std::abs(n[0]), std::abs(n[1]), std::abs(n[2])}), std::abs(n[axis])};
}

struct PointLattice {
  Vec3 low;
  double step;

  /// Number of the voxel around a lattice point; at most 2^20 steps per axis.
  std::uint64_t voxel_of(const Vec3& p) const {
    std::uint64_t number = 0;
    for (std::size_t k = 0; k < 3; ++k)
      number = number << 21 | static_cast<std::uint64_t>(std::floor((p[k] - low[k]) / step + 1.5));
    return number;
  }
};

/// Drops crossings of the overlap whose voxel has a point without them.
std::vector<SurfacePoint> thin(const std::vector<SurfacePoint>& certain,
                               const std::vector<SurfacePoint>& overlap,
                               const PointLattice& lattice) {
  std::vector<SurfacePoint> kept = certain;
  std::unordered_set<std::uint64_t> taken;  // asked, never iterated
  for (const SurfacePoint& point : certain) taken.insert(lattice.voxel_of(point.position));
  for (const SurfacePoint& point : overlap)
    if (taken.insert(lattice.voxel_of(point.position)).second) kept.push_back(point);
  return kept;
}

/// The crossings that count, in the order of axes and lattice lines.
std::vector<SurfacePoint> lattice_points(const Scene& scene, double cells, int threads) {
  const Scene::Bounds bounds = scene.bounds();
  const Vec3 low = bounds.low, extent = bounds.high - low;
  const double step = std::max({extent[0], extent[1], extent[2]}) / cells;
  std::vector<std::vector<SurfacePoint>> lines[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t across = (axis + 1) % 3, up = (axis + 2) % 3;
    const auto columns = static_cast<std::size_t>(extent[across] / step + 1e-6) + 1;
    const auto rows = static_cast<std::size_t>(extent[up] / step + 1e-6) + 1;
    lines[axis].resize(rows);
    parallel_ranges(rows, 1, threads, [&](std::size_t begin, std::size_t end) {
      std::vector<SurfacePoint> found;
      for (std::size_t row = begin; row < end; ++row)
        for (std::size_t column = 0; column < columns; ++column) {
          Ray ray;
          ray.origin[across] = low[across] + step * static_cast<double>(column);
          ray.origin[up] = low[up] + step * static_cast<double>(row);
          ray.origin[axis] = low[axis] - 1;
          ray.direction = {0, 0, 0};
          ray.direction[axis] = 1;
          found.clear();
          scene.crossings(ray, found);
          lines[axis][row].insert(lines[axis][row].end(), found.begin(), found.end());
        }
    });
  }
  std::vector<SurfacePoint> certain, overlap;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const auto& row : lines[axis])
      for (const SurfacePoint& point : row) {
        const auto [largest, along] = lean(point.normal, axis);
        if (along >= largest)
          certain.push_back(point);
        else if (along >= kOverlap * largest)
          overlap.push_back(point);
      }
  return thin(certain, overlap, {low, step});
}

std::array<float, 3> to_float(const Vec3& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

}  // namespace

PointCloud sample_points(const Scene& scene, int points, int threads, double* step) {
  double cells = scene.default_lattice();
  std::vector<SurfacePoint> surface = lattice_points(scene, cells, threads);
  if (points > 0) {  // the count grows with the square of the lattice
    cells *= std::sqrt(points / static_cast<double>(surface.size()));
    surface = lattice_points(scene, cells, threads);
  }
  if (step != nullptr) {
    const Vec3 extent = scene.bounds().high - scene.bounds().low;
    *step = std::max({extent[0], extent[1], extent[2]}) / cells;
  }
  PointCloud cloud;
  for (const SurfacePoint& point : surface) {
    cloud.positions.push_back(to_float(point.position));
    cloud.normals.push_back(to_float(point.normal));
    const Colour colour = scene.albedo(point);
    auto& stored = cloud.colours.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      stored[k] = static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(colour[k])));
  }
  return cloud;
}

}  // namespace slf::synth
