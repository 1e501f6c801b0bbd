// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "capture/nearest.h"
#include "capture/quantile.h"
#include "encoder/train/train_surfels.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr double kSurfelPixels = 8;     // side of a square of the surface that has one
constexpr double kCellsOfSquare = 1.5;  // that a slanted square of a cell's side touches
constexpr std::size_t kLeastSurfels = 8000, kMostSurfels = 60'000;
constexpr float kDiscReach = 2.2f;  // spacings: radius, of which a disc shows a third or so
constexpr float kWidest = 40;       // pixels
constexpr double kFiner = 0.7;

/// Means of points that fall into one cell of a grid.
SurfacePoints thinned(const SurfacePoints& points, double cell) {
  using Key = std::array<std::int32_t, 3>;
  std::vector<std::pair<Key, std::uint32_t>> order(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (std::size_t a = 0; a < 3; ++a)
      order[p].first[a] =
          std::int32_t(std::clamp(std::floor(double(points.positions[p][a]) / cell), -1e9, 1e9));
    order[p].second = std::uint32_t(p);
  }
  std::sort(order.begin(), order.end());
  SurfacePoints out;
  for (std::size_t i = 0, j = 0; i < order.size(); i = j) {
    Float3 position{}, normal{};
    for (; j < order.size() && order[j].first == order[i].first; ++j) {
      position = along(position, 1, points.positions[order[j].second]);
      normal = along(normal, 1, points.normals[order[j].second]);
    }
    const auto count = float(j - i);
    const float length = std::sqrt(dot(normal, normal));
    out.positions.push_back({position[0] / count, position[1] / count, position[2] / count});
    out.normals.push_back(length > 1e-3f
                              ? Float3{normal[0] / length, normal[1] / length, normal[2] / length}
                              : points.normals[order[i].second]);
  }
  return out;
}

/// Half of `most` to twice as many, by cells that shrink or grow: the spacing of a cloud with
/// points far away, or along the lines of a scanner, says little.
SurfacePoints thinned_to(const SurfacePoints& points, double spacing, std::size_t most) {
  double cell = spacing * std::sqrt(double(points.size()) / double(most));
  SurfacePoints some = thinned(points, cell);
  for (int i = 0; i < 8 && some.size() < most / 2; ++i) some = thinned(points, cell *= kFiner);
  while (some.size() > 2 * most) some = thinned(points, cell /= kFiner);
  return some;
}

/// Mean of what the photographs show where the point is, of cameras that it faces.
Float3 seen_colour(const Float3& position, const Float3& normal,
                   std::span<const TrainingView> views) {
  Float3 sum{};
  float count = 0;
  for (const TrainingView& view : views) {
    const TrainingCamera& camera = view.camera;
    const Float3 at = camera.in_camera(position), to = minus(camera.centre, position);
    const float cosine = dot(to, normal) / std::sqrt(std::max(dot(to, to), 1e-20f));
    if (!(at[2] > 0) || cosine < 0.3f) continue;
    const float u = camera.fx * at[0] / at[2] + camera.cx;
    const float v = camera.fy * at[1] / at[2] + camera.cy;
    if (!(u >= 0 && v >= 0 && u < float(camera.width) && v < float(camera.height))) continue;
    const std::size_t pixel = std::size_t(v) * std::size_t(camera.width) + std::size_t(u);
    for (std::size_t c = 0; c < 3; ++c) sum[c] += view.picture.plane(c)[pixel];
    ++count;
  }
  if (!(count > 0)) return {0.5f, 0.5f, 0.5f};
  return {sum[0] / count, sum[1] / count, sum[2] / count};
}

/// Mean distance to the three nearest others.
float distance_around(const NearestPoints& nearest, const Float3& position, std::size_t points) {
  const int k = int(std::min<std::size_t>(4, points));
  std::array<std::uint32_t, 4> index{};
  std::array<float, 4> square{};
  nearest.nearest(position, k, index.data(), square.data());
  float sum = 0;
  for (int i = 1; i < k; ++i) sum += std::sqrt(square[std::size_t(i)]);
  return k > 1 ? sum / float(k - 1) : 0;
}

}  // namespace

double training_pixel(std::span<const TrainingView> views) {
  std::vector<double> sizes;
  for (const TrainingView& view : views)
    sizes.push_back(double(view.camera.depth / std::max(view.camera.fx, view.camera.fy)));
  const double pixel = median(std::move(sizes));
  return pixel > 0 && std::isfinite(pixel) ? pixel : 1;
}

std::size_t surfels_for(const SurfacePoints& points, double pixel) {
  const auto cells = double(thinned(points, kSurfelPixels * pixel).size());
  return std::size_t(
      std::clamp(cells / kCellsOfSquare, double(kLeastSurfels), double(kMostSurfels)));
}

TrainedSurfels start_surfels(const SurfacePoints& points, double spacing,
                             std::span<const TrainingView> views, std::size_t most, float opacity,
                             int threads) {
  SurfacePoints some = points;
  if (points.size() > most) some = thinned_to(points, spacing, most);
  const NearestPoints nearest(some.positions);
  const auto pixel = float(training_pixel(views));
  TrainedSurfels surfels(some.size());
  parallel_ranges(some.size(), 256, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const float apart = distance_around(nearest, some.positions[p], some.size());
      const float radius = std::clamp(kDiscReach * apart, pixel, kWidest * pixel);
      surfels[p] = flat_surfel(some.positions[p], some.normals[p], radius, opacity);
      const Float3 colour = seen_colour(some.positions[p], some.normals[p], views);
      for (std::size_t c = 0; c < 3; ++c)
        surfels[p].value[TrainedSurfel::kColour + c] = (colour[c] - 0.5f) / kMeanFunction;
    }
  });
  return surfels;
}

}  // namespace slf
