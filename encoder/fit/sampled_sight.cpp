// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/sampled_sight.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "capture/photograph_size.h"
#include "capture/spacing.h"
#include "encoder/fit/observe_points.h"
#include "geometry/morton.h"

namespace slf {
namespace {

constexpr std::size_t kLookedAt = 30'000;             // points
constexpr double kMostMegapixels = (1 << 20) * 1e-6;  // more tells no more of colours
constexpr int kOrderBits = 10;                        // of an axis, of the order of the sample

/// Every so many-th point, with its normal or one that is estimated from the sample.
ObservedPoints sampled_points(const Capture& capture, const PointCloud& cloud, int threads) {
  const std::size_t all = cloud.positions.size(), taken = std::min(kLookedAt, all);
  PointCloud sample;
  for (std::size_t i = 0; i < taken; ++i) {
    const std::size_t p = i * all / taken;
    const auto& at = cloud.positions[p];
    if (!std::isfinite(at[0] + at[1] + at[2])) continue;
    sample.positions.push_back(cloud.positions[p]);
    if (!cloud.normals.empty()) sample.normals.push_back(cloud.normals[p]);
  }
  std::vector<Vec3> viewpoints;
  for (const Camera& camera : capture.cameras) viewpoints.push_back(camera.centre());
  if (sample.normals.empty()) sample.normals = estimate_normals(sample, viewpoints, 16, threads);
  return {std::move(sample.positions), std::move(sample.normals)};
}

/// Neighbours in space follow each other.
ObservedPoints in_morton_order(const ObservedPoints& points) {
  std::array<float, 3> low = points.positions.front(), high = low;
  for (const auto& p : points.positions)
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  const float extent = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  const float cells = float((1 << kOrderBits) - 1) / std::max(extent, 1e-30f);
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  for (std::size_t i = 0; i < points.positions.size(); ++i) {
    const auto& p = points.positions[i];
    const auto cell = [&](std::size_t k) { return std::int32_t((p[k] - low[k]) * cells); };
    order.emplace_back(morton({cell(0), cell(1), cell(2)}), i);
  }
  std::sort(order.begin(), order.end());
  ObservedPoints sorted;
  for (const auto& [code, i] : order) {
    sorted.positions.push_back(points.positions[i]);
    sorted.normals.push_back(points.normals[i]);
  }
  return sorted;
}

}  // namespace

Result<Observations, InputError> sampled_sight(const Capture& capture, const PointCloud& cloud,
                                               std::span<const int> cameras, int threads) {
  const ObservedPoints sample = sampled_points(capture, cloud, threads);
  const double spacing = typical_spacing(sample.positions);
  if (!(spacing > 0)) return Observations{};
  const ObservedPoints points = in_morton_order(sample);
  ObserveSettings observing;
  observing.threads = threads;
  std::optional<Capture> within;
  if (capture.images.empty())
    within = photographs_within(photographs_alone(capture), kMostMegapixels);
  const Capture& looked_at = within ? *within : capture;
  const auto depth_of = [&](int camera) -> Result<DepthBuffer, InputError> {
    return DepthBuffer(looked_at.cameras[std::size_t(camera)], points.positions,
                       {observing.occlusion_resolution, spacing, observing.depth_tolerance});
  };
  SLF_TRY(SeenPoints seen, observe_points(looked_at, cameras, points, depth_of, observing));
  return std::move(seen.observations);
}

Result<std::vector<CameraTrust>, InputError> foreign_photographs(const Capture& capture,
                                                                 const PointCloud& cloud,
                                                                 std::span<const int> cameras,
                                                                 int threads) {
  SLF_TRY(const Observations seen, sampled_sight(capture, cloud, cameras, threads));
  std::vector<CameraTrust> foreign;
  if (seen.first.size() < 2) return foreign;
  const auto trust = check_cameras(seen, threads);
  if (!trust) return foreign;
  for (const CameraTrust& t : *trust)
    if (t.verdict == CameraVerdict::kDropped) foreign.push_back(t);
  return foreign;
}

}  // namespace slf
