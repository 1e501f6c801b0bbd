// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/cover_views.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "encoder/fit/observe_depth.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr float kSeenThrough = 2.5f;  // lattice steps outside: views see what is behind

// Lattice steps: from the plane that a view shows, and along the ray.
constexpr float kShown = 1.5f, kShownBeyond = 6;
constexpr double kSlanted = 1.4;  // lattice steps between points of a slanted surface

using NodeKey = std::array<std::int32_t, 3>;

struct NodeHash {
  std::size_t operator()(const NodeKey& key) const {
    std::uint64_t hash = 0;
    for (const std::int32_t k : key) hash = (hash ^ std::uint32_t(k)) * 0x9e3779b97f4a7c15u;
    return std::size_t(hash ^ (hash >> 32));
  }
};

NodeKey node_of(const Lattice& lattice, const Float3& at) {
  constexpr double kBound = 1e9;  // beyond there are no blocks
  NodeKey key{};
  for (std::size_t a = 0; a < 3; ++a)
    key[a] = std::int32_t(std::lround(
        std::clamp((double(at[a]) - lattice.origin[a]) / lattice.step, -kBound, kBound)));
  return key;
}

/// In lattice steps; 0 where nothing is known.
float distance_at(const DistanceBlocks& all, const NodeKey& node) {
  const auto block = [](std::int32_t n) { return n >> 3; };
  const DistanceBlock* found = all.find({block(node[0]), block(node[1]), block(node[2])});
  if (found == nullptr) return 0;
  const auto i =
      std::size_t(((node[2] & 7) * kBlockNodes + (node[1] & 7)) * kBlockNodes + (node[0] & 7));
  if (!(found->weight[i] > 0)) return 0;
  return found->distance[i] / found->weight[i] / float(all.lattice.step);
}

/// The points from one view: as fat as closes the holes between them, and no fatter.
DepthBuffer drawn_points(const TrainingCamera& camera, const SurfacePoints& points, double step) {
  Camera exact;
  exact.width = camera.width, exact.height = camera.height;
  exact.fx = double(camera.fx), exact.fy = double(camera.fy);
  exact.cx = double(camera.cx), exact.cy = double(camera.cy);
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t a = 0; a < 3; ++a) exact.rotation[r][a] = double(camera.rotation[r][a]);
    exact.translation[r] = double(camera.translation[r]);
  }
  return {exact, points.positions, {1, kSlanted * 0.6 * step, 2.5}};
}

/// Marks the points that are what the view shows, and face it.
void mark_shown(const ShownSurface& shown, const SurfacePoints& points, float step, int threads,
                std::vector<std::uint8_t>& marks) {
  const TrainingCamera& camera = *shown.camera;
  parallel_ranges(marks.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      if (marks[p] != 0) continue;
      const Float3 at = camera.in_camera(points.positions[p]);
      const Float3 to_camera = minus(camera.centre, points.positions[p]);
      if (!(at[2] > 0) || !(dot(to_camera, points.normals[p]) > 0)) continue;
      const float u = camera.fx * at[0] / at[2] + camera.cx;
      const float v = camera.fy * at[1] / at[2] + camera.cy;
      if (!(u >= 0 && v >= 0 && u < float(camera.width) && v < float(camera.height))) continue;
      const std::size_t pixel = std::size_t(v) * std::size_t(camera.width) + std::size_t(u);
      if (!(shown.depths.depth[pixel] > 0)) continue;
      const Float3 apart = minus(points.positions[p], shown.point(pixel));
      marks[p] = std::abs(dot(apart, shown.normal(pixel))) < kShown * step &&
                 std::abs(at[2] - shown.depths.depth[pixel]) < kShownBeyond * step;
    }
  });
}

SurfacePoints without_unmarked(const SurfacePoints& points,
                               const std::vector<std::uint8_t>& marks) {
  SurfacePoints out;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (p < marks.size() && marks[p] == 0) continue;
    out.positions.push_back(points.positions[p]);
    out.normals.push_back(points.normals[p]);
    out.source.push_back(std::uint32_t(out.source.size()));
  }
  return out;
}

}  // namespace

void cover_views(const TrainedSurfels& surfels, std::span<const TrainingView> views,
                 const DistanceBlocks& distances, double apart, int threads,
                 SurfacePoints& points) {
  const Lattice& lattice = distances.lattice;
  std::unordered_set<NodeKey, NodeHash> taken;
  for (const Float3& at : points.positions) taken.insert(node_of(lattice, at));
  std::vector<std::uint8_t> marks(points.size(), 0);
  const auto behind = float(apart * lattice.step);
  for (const TrainingView& view : views) {
    const ShownSurface shown = shown_surface(surfels, view, threads);
    mark_shown(shown, points, float(lattice.step), threads, marks);
    DepthBuffer drawn = drawn_points(view.camera, points, lattice.step);
    const auto depths = drawn.depths();
    for (std::size_t pixel = 0; pixel < depths.size(); ++pixel) {
      const float depth = shown.depths.depth[pixel];
      if (!(depth > 0) || depths[pixel] < depth + behind) continue;
      const NodeKey node = node_of(lattice, shown.point(pixel));
      if (distance_at(distances, node) > kSeenThrough || !taken.insert(node).second) continue;
      Float3 at{};
      for (std::size_t a = 0; a < 3; ++a) at[a] = float(lattice.origin[a] + lattice.step * node[a]);
      points.positions.push_back(at);
      points.normals.push_back(shown.normal(pixel));
      points.source.push_back(std::uint32_t(points.source.size()));
    }
  }
  points = without_unmarked(points, marks);
}

}  // namespace slf
