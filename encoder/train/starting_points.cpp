// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/starting_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "capture/nearest.h"
#include "capture/quantile.h"
#include "capture/spacing.h"
#include "capture/surface_points.h"
#include "encoder/train/chance.h"
#include "encoder/measure/outlines.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr int kCoarse = 48, kFine = 128;  // cells along the longest side
constexpr std::size_t kLeastHull = 300;   // points: fewer are no object
constexpr double kOnHull = 1;             // of its cells, from it: half of the points
constexpr std::size_t kVolumePoints = 30'000;
constexpr double kCore = 0.7;  // of the radius: where the object is, mostly

/// Cells of a box that are in the object as all outlines have it.
struct Cells {
  Vec3 low{0, 0, 0};
  double side = 0;  ///< of a cell
  std::array<int, 3> count{};
  std::vector<std::uint8_t> inside;

  std::size_t at(int x, int y, int z) const {
    return (std::size_t(z) * std::size_t(count[1]) + std::size_t(y)) * std::size_t(count[0]) +
           std::size_t(x);
  }
  bool has(int x, int y, int z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < count[0] && y < count[1] && z < count[2] &&
           inside[at(x, y, z)] != 0;
  }
  Vec3 middle(int x, int y, int z) const {
    return {low[0] + (x + 0.5) * side, low[1] + (y + 0.5) * side, low[2] + (z + 0.5) * side};
  }
};

Cells carve(const std::vector<Outline>& outlines, const Vec3& low, const Vec3& high, int most,
            int threads) {
  Cells cells;
  cells.low = low;
  const Vec3 size{high[0] - low[0], high[1] - low[1], high[2] - low[2]};
  cells.side = std::max({size[0], size[1], size[2]}) / most;
  for (std::size_t a = 0; a < 3; ++a)
    cells.count[a] = std::max(int(std::ceil(size[a] / cells.side)), 1);
  cells.inside.resize(cells.at(0, 0, cells.count[2]));
  parallel_ranges(std::size_t(cells.count[2]), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (int z = int(begin); z < int(end); ++z)
      for (int y = 0; y < cells.count[1]; ++y)
        for (int x = 0; x < cells.count[0]; ++x)
          cells.inside[cells.at(x, y, z)] =
              in_hull(outlines, cells.middle(x, y, z), cells.side / 2);
  });
  return cells;
}

/// What the coarse cells leave of the box, and a cell around it; false: nothing.
bool shrink(const Cells& cells, Vec3& low, Vec3& high) {
  std::array<int, 3> least = cells.count, most{-1, -1, -1};
  for (int z = 0; z < cells.count[2]; ++z)
    for (int y = 0; y < cells.count[1]; ++y)
      for (int x = 0; x < cells.count[0]; ++x) {
        if (!cells.has(x, y, z)) continue;
        const std::array<int, 3> at{x, y, z};
        for (std::size_t a = 0; a < 3; ++a) {
          least[a] = std::min(least[a], at[a]);
          most[a] = std::max(most[a], at[a]);
        }
      }
  if (most[0] < 0) return false;
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = cells.low[a] + (least[a] - 1) * cells.side;
    high[a] = cells.low[a] + (most[a] + 2) * cells.side;
  }
  return true;
}

/// Away from the cells around that are inside; 0 where those say nothing.
Float3 outward(const Cells& cells, int x, int y, int z) {
  constexpr int kAround = 3;
  Float3 sum{};
  for (int c = -kAround; c <= kAround; ++c)
    for (int b = -kAround; b <= kAround; ++b)
      for (int a = -kAround; a <= kAround; ++a)
        if (a * a + b * b + c * c <= kAround * kAround && cells.has(x + a, y + b, z + c))
          sum = minus(sum, {float(a), float(b), float(c)});
  return sum;
}

void add_point(const Vec3& at, const Float3& towards, PointCloud& cloud) {
  const float length = std::sqrt(dot(towards, towards));
  if (!(length > 0)) return;
  cloud.positions.push_back({float(at[0]), float(at[1]), float(at[2])});
  cloud.normals.push_back({towards[0] / length, towards[1] / length, towards[2] / length});
}

PointCloud hull_surface(const Cells& cells) {
  PointCloud cloud;
  for (int z = 0; z < cells.count[2]; ++z)
    for (int y = 0; y < cells.count[1]; ++y)
      for (int x = 0; x < cells.count[0]; ++x) {
        if (!cells.has(x, y, z)) continue;
        const bool buried = cells.has(x - 1, y, z) && cells.has(x + 1, y, z) &&
                            cells.has(x, y - 1, z) && cells.has(x, y + 1, z) &&
                            cells.has(x, y, z - 1) && cells.has(x, y, z + 1);
        if (!buried) add_point(cells.middle(x, y, z), outward(cells, x, y, z), cloud);
      }
  return cloud;
}

PointCloud hull_of(const std::vector<Outline>& outlines, const LookedAt& ball, int threads) {
  Vec3 low = ball.centre, high = ball.centre;
  for (std::size_t a = 0; a < 3; ++a) low[a] -= ball.radius, high[a] += ball.radius;
  if (!shrink(carve(outlines, low, high, kCoarse, threads), low, high)) return {};
  return hull_surface(carve(outlines, low, high, kFine, threads));
}

/// Evenly in the ball's core, facing outwards.
PointCloud volume_of(const LookedAt& ball) {
  PointCloud cloud;
  Chance chance{1};
  while (cloud.positions.size() < kVolumePoints) {
    Float3 at{};
    for (float& x : at) x = float(2 * chance.share() - 1);
    if (dot(at, at) > 1) continue;
    Vec3 world = ball.centre;
    for (std::size_t a = 0; a < 3; ++a) world[a] += kCore * ball.radius * double(at[a]);
    add_point(world, at, cloud);
  }
  return cloud;
}

}  // namespace

bool lies_on(const PointCloud& hull, const PointCloud& points) {
  const NearestPoints tree(hull.positions);
  std::vector<float> squares(points.positions.size());
  for (std::size_t p = 0; p < squares.size(); ++p) {
    std::uint32_t nearest = 0;
    tree.nearest(points.positions[p], 1, &nearest, &squares[p]);
  }
  const double apart = std::sqrt(double(median(std::move(squares))));
  return apart <= kOnHull * typical_spacing(hull.positions);
}

Result<StartingPoints, InputError> starting_points(const Capture& capture,
                                                   std::span<const int> cameras, int threads) {
  SLF_TRY(const LookedAt ball, looked_at(capture, cameras));
  SLF_TRY(const auto outlines, outlines_of(capture, cameras, threads));
  if (are_outlined(outlines.size(), cameras.size())) {
    PointCloud hull = hull_of(outlines, ball, threads);
    if (hull.positions.size() >= kLeastHull) return StartingPoints{std::move(hull), StartId::kHull};
  }
  return StartingPoints{volume_of(ball), StartId::kVolume};
}

}  // namespace slf
