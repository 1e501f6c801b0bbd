// SPDX-License-Identifier: Apache-2.0
// One definition of quality. Spec annex D.
#include "slf/evaluate.h"

#include <algorithm>
#include <cmath>

#include "base/error_sum.h"
#include "base/input_error.h"
#include "capture/nearest.h"
#include "encoder/fit/observe_camera.h"
#include "encoder/fit/observe_points.h"
#include "encoder/measure/captured_view.h"
#include "encoder/measure/evaluate_images.h"
#include "lightfield/colour.h"
#include "slf/fit.h"
#include "slf/parallel.h"
#include "slf/render.h"

namespace slf {
namespace {

/// Decoded points, from the capture's origin, with the normals of the nearest captured ones.
ObservedPoints decoded_points(const ViewMaps& maps, const Vec3& origin,
                              const CapturedSurface& surface, const NearestPoints& tree,
                              int threads) {
  ObservedPoints points;
  const Grid grid = moved(maps.header().grid, {-origin[0], -origin[1], -origin[2]});
  points.positions.resize(maps.num_points());
  points.normals.resize(maps.num_points());
  parallel_ranges(maps.num_points(), 1024, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Vec3 world = grid.world(maps.positions()[p]);
      points.positions[p] = {float(world[0]), float(world[1]), float(world[2])};
      std::uint32_t nearest = 0;
      tree.nearest(points.positions[p], 1, &nearest, nullptr);
      points.normals[p] = surface.normals[nearest];
    }
  });
  return points;
}

/// 8-bit display value of a grey level of the given transfer.
double to_display(float value, Transfer transfer) {
  const double clamped = std::clamp(static_cast<double>(value), 0.0, 255.0);
  const double display =
      transfer == Transfer::kLinear ? 255 * linear_to_srgb(clamped / 255) : clamped;
  return std::floor(display + 0.5);
}

/// One sum per δ′. `seen` holds the views of the smallest; the cone is the observer's own.
std::vector<ErrorSum> point_errors(const ViewMaps& maps, const Capture& capture,
                                   const ObservedPoints& points, const Observations& seen,
                                   const std::vector<double>& deltas, int threads) {
  constexpr std::size_t kGrain = 1024;
  std::vector<Vec3> centres;
  for (const Camera& camera : capture.cameras) centres.push_back(camera.centre());
  std::vector<double> least;
  for (const double delta : deltas) least.push_back(least_cosine(delta));
  std::vector<std::vector<ErrorSum>> parts((maps.num_points() + kGrain - 1) / kGrain,
                                           std::vector<ErrorSum>(deltas.size()));
  parallel_ranges(maps.num_points(), kGrain, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<ErrorSum>& part = parts[begin / kGrain];
    for (std::size_t p = begin; p < end; ++p)
      for (std::uint64_t i = seen.first[p]; i < seen.first[p + 1]; ++i) {
        const auto [theta, gamma] = seen.direction[i];
        const auto radiance = maps.radiance(p, theta, gamma);
        std::array<double, 3> error{};
        for (std::size_t k = 0; k < 3; ++k)
          error[k] = to_display(radiance[k], maps.header().transfer) -
                     to_display(seen.colour[i][k], Transfer::kDisplay);
        const double cosine =
            view_cosine(points.positions[p], points.normals[p], centres[seen.camera[i]]);
        for (std::size_t d = 0; d < deltas.size(); ++d)
          if (cosine >= least[d]) part[d].add(error);
      }
  });
  std::vector<ErrorSum> sums(deltas.size());
  for (const auto& part : parts)
    for (std::size_t d = 0; d < deltas.size(); ++d) sums[d].add_all(part[d]);
  return sums;
}

/// Cameras of the capture, and points that say where its surface is.
Result<Done, InputError> check_cameras(const Capture& capture, std::span<const int> cameras) {
  if (cameras.empty()) return invalid_argument("evaluation needs at least one camera");
  if (capture.cloud.positions.empty())
    return invalid_argument("evaluation needs the capture's points");
  for (const int camera : cameras)
    if (camera < 0 || std::size_t(camera) >= capture.cameras.size())
      return invalid_argument("camera index beyond the capture's cameras");
  return Done{};
}

}  // namespace

Result<Quality, InputError> evaluate(const ViewMaps& maps, const Capture& capture,
                                     std::span<const int> cameras, const EvaluateSettings& settings,
                                     const Progress& progress) {
  SLF_CHECK(check_cameras(capture, cameras));
  if (maps.num_points() == 0) return invalid_argument("the light field has no points");
  if (settings.deltas_degrees.empty())
    return invalid_argument("evaluation needs at least one delta");
  for (const double delta : settings.deltas_degrees)
    if (!(delta >= 0 && delta <= 90)) return invalid_argument("delta must be 0 .. 90 degrees");
  const NearestPoints tree(capture.cloud.positions);
  CapturedSurface surface = captured_surface(capture, settings.threads);
  if (!(surface.spacing > 0)) surface.spacing = maps.header().grid.step;  // a single point
  const ObservedPoints points =
      decoded_points(maps, capture.origin, surface, tree, settings.threads);
  ObserveSettings observing;
  observing.delta_degrees =
      *std::min_element(settings.deltas_degrees.begin(), settings.deltas_degrees.end());
  observing.depth_tolerance = settings.depth_tolerance;
  observing.threads = settings.threads;
  SLF_TRY(const SeenPoints seen, observe_behind(capture, cameras, points, capture.cloud.positions,
                                                surface.spacing, observing, progress));
  const bool nothing = seen.observations.camera.empty();
  const InputError unseen = nothing_seen(seen.counts, cameras.size(), points.positions.size());
  if (nothing && !settings.images) return unseen;

  Quality quality;
  const auto errors = point_errors(maps, capture, points, seen.observations,
                                   settings.deltas_degrees, settings.threads);
  for (std::size_t d = 0; d < errors.size(); ++d) {
    const ErrorSum& e = errors[d];
    quality.points.push_back({settings.deltas_degrees[d],
                              e.psnr(),
                              e.luma_psnr(),
                              {e.channel_psnr(0), e.channel_psnr(1), e.channel_psnr(2)},
                              e.count});
  }
  if (settings.images) {
    RenderSettings over_black;
    over_black.background = {0, 0, 0};
    over_black.threads = 1;
    const Renderer renderer(maps, over_black);
    const DrawPicture draw = [&](const Camera& camera) { return renderer.render(camera); };
    SLF_CHECK(evaluate_images(draw, capture, cameras, surface, settings, progress, quality));
    if (nothing && !(quality.image.coverage > 0)) return unseen;
  }
  return quality;
}

Result<Quality, InputError> evaluate_pictures(const DrawPicture& draw, const Capture& capture,
                                              std::span<const int> cameras,
                                              const EvaluateSettings& settings,
                                              const Progress& progress) {
  SLF_CHECK(check_cameras(capture, cameras));
  CapturedSurface surface = captured_surface(capture, settings.threads);
  if (!(surface.spacing > 0)) surface.spacing = 1;  // a single point
  Quality quality;
  SLF_CHECK(evaluate_images(draw, capture, cameras, surface, settings, progress, quality));
  return quality;
}

QualityGap quality_gap(const Quality& unquantised, const Quality& coded) {
  QualityGap gap;
  gap.coverage = coded.image.uncovered_error_share;
  if (!std::isfinite(coded.image.psnr) || unquantised.points.empty()) return gap;  // no error
  // Mean squared errors in units of that of the coded pictures where both show the object.
  const auto relative = [&](double psnr) { return std::pow(10, (coded.image.psnr - psnr) / 10); };
  const double rest = 1 - gap.coverage;
  const double points = relative(unquantised.points[0].psnr);
  const double pictures = relative(unquantised.image.psnr);
  gap.points = rest * points;
  gap.splatting = rest * (pictures - points);
  gap.quantisation = rest * (1 - pictures);
  return gap;
}

}  // namespace slf
