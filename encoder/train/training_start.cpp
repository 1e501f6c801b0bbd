// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/training_start.h"

#include <algorithm>

#include "capture/density.h"
#include "capture/spacing.h"

namespace slf {
namespace {

constexpr double kMostPixels = 1 << 20;                      // of a photograph
constexpr double kPixelBytes = 3 * sizeof(float) * 4.0 / 3;  // with those of the coarser sizes
constexpr float kThinOpacity = 0.1f;                         // of surfels that start anywhere

SurfacePoints start_of(const Capture& capture, int threads, TrainingCache* cache) {
  SurfacePoints points{capture.cloud.positions, capture.cloud.normals, {}};
  if (!points.normals.empty()) return points;
  if (cache != nullptr && cache->normals.size() == points.size()) {
    points.normals = cache->normals;
    return points;
  }
  std::vector<Vec3> viewpoints;
  for (const Camera& camera : capture.cameras) viewpoints.push_back(camera.centre());
  points.normals = estimate_normals(capture.cloud, viewpoints, 16, threads);
  if (cache != nullptr) cache->normals = points.normals;
  return points;
}

/// Halvings after which all photographs fit.
int reduction_of(const Capture& capture, std::span<const int> cameras, double most_bytes) {
  double largest = 0, all = 0;
  for (const int c : cameras) {
    const Camera& camera = capture.cameras[std::size_t(c)];
    const double pixels = double(camera.width) * double(camera.height);
    largest = std::max(largest, pixels);
    all += kPixelBytes * pixels;
  }
  int log2 = 0;
  while (largest > kMostPixels || all > most_bytes) largest /= 4, all /= 4, ++log2;
  return log2;
}

}  // namespace

Result<TrainingStart, InputError> training_start(const Capture& capture,
                                                 std::span<const int> cameras,
                                                 const TrainGeometrySettings& settings,
                                                 const Progress& progress) {
  TrainingStart start;
  start.points = start_of(capture, settings.threads, settings.cache);
  start.spacing = typical_spacing(start.points.positions);
  if (!(start.spacing > 0)) return start;
  SLF_TRY(start.views,
          load_training_views(capture, cameras, start.points, start.spacing,
                              reduction_of(capture, cameras, settings.photograph_bytes),
                              settings.threads, settings.cache));
  TrainSettings& training = start.settings;
  training.iterations = settings.iterations;
  training.threads = settings.threads;
  training.seconds = settings.seconds;
  training.work = settings.work;
  training.resume = settings.resume;
  training.surfels = settings.surfels > 0 ? settings.surfels
                                          : surfels_for(start.points, training_pixel(start.views));
  if (progress)
    training.progress = [&progress](double done) {
      progress("train", done);
      return true;
    };
  return start;
}

TrainedSurfels first_surfels(const TrainingStart& start, const TrainGeometrySettings& settings) {
  return start_surfels(start.points, start.spacing, start.views, start.settings.surfels / 2,
                       settings.is_volume ? kThinOpacity : kSolidOpacity, settings.threads);
}

}  // namespace slf
