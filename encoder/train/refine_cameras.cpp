// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/refine_cameras.h"

#include <algorithm>
#include <cmath>

#include "base/stopwatch.h"
#include "capture/quantile.h"
#include "encoder/train/camera_twists.h"
#include "encoder/train/train_gaussians.h"

namespace slf {
namespace {

constexpr std::size_t kLooked = 1000;  // points, by whose pictures a motion is told

/// Root mean square of what pictures of the points move by; 0 where none is seen.
double motion_between(const Camera& before, const Camera& after, const PointCloud& cloud) {
  const std::size_t stride = std::max<std::size_t>(cloud.positions.size() / kLooked, 1);
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t p = 0; p < cloud.positions.size(); p += stride) {
    const auto& at = cloud.positions[p];
    const Vec3 world{at[0], at[1], at[2]};
    const auto was = before.project(world), is = after.project(world);
    if (!was || !is) continue;
    squares += std::pow((*is)[0] - (*was)[0], 2) + std::pow((*is)[1] - (*was)[1], 2);
    ++count;
  }
  return count > 0 ? std::sqrt(squares / double(count)) : 0;
}

}  // namespace

Result<PoseReport, InputError> refine_cameras(const Capture& capture, std::span<const int> cameras,
                                              TrainGeometrySettings settings,
                                              const Progress& progress) {
  Stopwatch watch;
  PoseReport report;
  CameraTwists twists;
  settings.twists = &twists;
  SLF_TRY(const Gaussians splats, train_gaussians(capture, cameras, settings, progress));
  if (splats.size() == 0 || twists.empty()) return report;
  report.cameras = capture.cameras;
  std::vector<double> pixels;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    Camera& camera = report.cameras[std::size_t(cameras[i])];
    const Camera before = camera;
    camera = twisted(before, twists.twist(i), twists.pivot());
    pixels.push_back(motion_between(before, camera, capture.cloud));
    if (pixels.back() > report.most_pixels)
      report.most_pixels = pixels.back(), report.moved_most = cameras[i];
  }
  report.median_pixels = median(std::move(pixels));
  report.seconds = watch.lap();
  return report;
}

}  // namespace slf
