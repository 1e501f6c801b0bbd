// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "base/input_error.h"
#include "base/release.h"
#include "encoder/fit/local_observations.h"
#include "encoder/fit/observe_camera.h"
#include "encoder/fit/observe_points.h"
#include "slf/fit.h"
#include "slf/parallel.h"

namespace slf {
namespace {

Result<Done, InputError> check(const Capture& capture, std::span<const int> cameras,
                               const ObservedPoints& points, const ObserveSettings& settings) {
  if (!(settings.delta_degrees >= 0 && settings.delta_degrees <= 90))
    return invalid_argument("delta must be 0 .. 90 degrees");
  if (!(settings.occlusion_resolution >= 0.05 && settings.occlusion_resolution <= 8))
    return invalid_argument("occlusion resolution must be 0.05 .. 8");
  if (!(settings.depth_tolerance >= 0 && std::isfinite(settings.depth_tolerance)))
    return invalid_argument("depth tolerance must be 0 or more");
  if (points.positions.size() != points.normals.size())
    return invalid_argument("as many normals as points are needed");
  if (points.positions.size() > std::numeric_limits<std::uint32_t>::max())
    return invalid_argument("more than 2^32 - 1 points");
  for (const int camera : cameras)
    if (camera < 0 || static_cast<std::size_t>(camera) >= capture.cameras.size() ||
        camera > std::numeric_limits<std::uint16_t>::max())
      return invalid_argument("camera " + std::to_string(camera) + " is not one of the capture's " +
                              std::to_string(capture.cameras.size()) + " (65536 at most)");
  return Done{};
}

/// One camera's sightings, or why there are none.
struct CameraResult {
  CameraSightings seen;
  std::optional<InputError> error;
};

std::vector<CameraResult> observe_each(const Capture& capture, const std::vector<int>& order,
                                       const CameraObserver& observer,
                                       const DepthOfCamera& depth_of, int threads,
                                       const Progress& progress) {
  std::vector<CameraResult> results(order.size());
  const auto body = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto image = load_image(capture, order[i]);
      const auto depth =
          image ? depth_of(order[i]) : Result<DepthBuffer, InputError>(image.error());
      if (depth)
        results[i].seen =
            observer.observe(capture.cameras[static_cast<std::size_t>(order[i])], *image, *depth);
      else
        results[i].error = depth.error();
    }
  };
  parallel_ranges(order.size(), 1, threads, body, [&](std::size_t done) {
    if (progress)
      progress("observe", static_cast<double>(done) / static_cast<double>(order.size()));
  });
  return results;
}

/// Lists of each camera, in ascending order, to lists of each point. Frees the former.
Observations group_by_point(std::vector<CameraResult>& results, const std::vector<int>& order,
                            std::size_t points) {
  Observations out;
  out.first.assign(points + 1, 0);
  for (const CameraResult& result : results)
    for (const Sighting& s : result.seen.sightings) ++out.first[s.point + 1];
  for (std::size_t p = 0; p < points; ++p) out.first[p + 1] += out.first[p];
  const auto total = static_cast<std::size_t>(out.first[points]);
  out.direction.resize(total);
  out.colour.resize(total);
  out.camera.resize(total);
  std::vector<std::uint64_t> next(out.first.begin(), out.first.end() - 1);
  for (std::size_t i = 0; i < results.size(); ++i) {
    for (const Sighting& s : results[i].seen.sightings) {
      const auto at = static_cast<std::size_t>(next[s.point]++);
      out.direction[at] = s.direction;
      out.colour[at] = s.colour;
      out.camera[at] = static_cast<std::uint16_t>(order[i]);
    }
    release(results[i].seen.sightings);
  }
  return out;
}

}  // namespace

InputError nothing_seen(const SightingCounts& sum, std::size_t cameras, std::size_t points) {
  const bool masked = sum.visible > 0;
  return {
      Errc::kInvalidInput,
      std::string(masked ? "masks or alpha hide every point (128 and more, white, is the object: "
                           "invert them, or leave them out): "
                         : "") +
          "no camera sees any point: of " + std::to_string(cameras) + " cameras x " +
          std::to_string(points) + " points, " + std::to_string(sum.facing) +
          " face the camera within delta, " + std::to_string(sum.inside) +
          " of them project into the image, " + std::to_string(sum.visible) +
          " of those are not hidden, and none is free of the mask"};
}

Result<SeenPoints, InputError> observe_points(const Capture& capture, std::span<const int> cameras,
                                              const ObservedPoints& points,
                                              const DepthOfCamera& depth_of,
                                              const ObserveSettings& settings,
                                              const Progress& progress) {
  SLF_CHECK(check(capture, cameras, points, settings));
  std::vector<int> order(cameras.begin(), cameras.end());
  std::sort(order.begin(), order.end());
  order.erase(std::unique(order.begin(), order.end()), order.end());
  const CameraObserver observer(points, settings);
  auto results = observe_each(capture, order, observer, depth_of, settings.threads, progress);
  SeenPoints seen;
  for (const CameraResult& result : results) {
    if (result.error) return *result.error;
    seen.counts += result.seen.counts;
  }
  seen.observations = group_by_point(results, order, points.positions.size());
  set_gamma_range(seen.observations);
  return seen;
}

Result<SeenPoints, InputError> observe_behind(const Capture& capture, std::span<const int> cameras,
                                              const ObservedPoints& points,
                                              std::span<const std::array<float, 3>> occluders,
                                              double spacing, const ObserveSettings& settings,
                                              const Progress& progress) {
  if (!(spacing > 0 && std::isfinite(spacing)))
    return InputError{Errc::kInvalidArgument, "spacing must be positive"};
  const DepthSettings depth{settings.occlusion_resolution, spacing, settings.depth_tolerance};
  const auto depth_of = [&](int index) -> Result<DepthBuffer, InputError> {
    const Camera& camera = capture.cameras[static_cast<std::size_t>(index)];
    return capture.mesh.triangles.empty() ? DepthBuffer(camera, occluders, depth)
                                          : DepthBuffer(camera, capture.mesh, depth);
  };
  return observe_points(capture, cameras, points, depth_of, settings, progress);
}

Result<Observations, InputError> observe(const Capture& capture, std::span<const int> cameras,
                                         const ObservedPoints& points,
                                         std::span<const std::array<float, 3>> occluders,
                                         double spacing, const ObserveSettings& settings,
                                         const Progress& progress) {
  SLF_TRY(SeenPoints seen,
          observe_behind(capture, cameras, points, occluders, spacing, settings, progress));
  if (seen.observations.camera.empty())
    return nothing_seen(seen.counts, cameras.size(), points.positions.size());
  return std::move(seen.observations);
}

}  // namespace slf
