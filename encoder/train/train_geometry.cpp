// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/train_geometry.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "capture/density.h"
#include "capture/spacing.h"
#include "encoder/train/fuse_surfels.h"
#include "encoder/train/train_surfels.h"
#include "encoder/train/training_start.h"

namespace slf {
namespace {

constexpr std::size_t kLeastPoints = 50;
constexpr double kPixelsPerVoxel = 1.6;  // between points: docs/decisions/020
constexpr double kTrainedBefore = 0.8;   // of the iterations, with some of the photographs
constexpr double kFewOutside = 0.002, kManyOutside = 0.02;  // of the surfels, of a box
constexpr std::size_t kLeastFused = 500;                    // fewer are nothing like a surface
constexpr std::size_t kMostFused = 1'000'000;               // points, about
constexpr double kFinest = 0.5;  // automatic steps: a finer grid gets points no closer than that

/// Largest side of the box of most surfels: some may be anywhere.
/// @param outside  share of them at either end of an axis
double extent_of(const TrainedSurfels& surfels, double outside) {
  double extent = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    std::vector<float> values;
    for (const TrainedSurfel& surfel : surfels) values.push_back(surfel.position()[a]);
    const auto share = std::ptrdiff_t(outside * double(values.size()));
    std::nth_element(values.begin(), values.begin() + share, values.end());
    const float low = values[std::size_t(share)];
    std::nth_element(values.begin(), values.end() - 1 - share, values.end());
    extent = std::max(extent, double(*(values.end() - 1 - share)) - double(low));
  }
  return extent;
}

/// What photographs resolve, and the memory of a surface of about so many points.
double automatic_step(const TrainedSurfels& surfels, double pixel) {
  return std::max(kPixelsPerVoxel * pixel,
                  extent_of(surfels, kManyOutside) / std::sqrt(double(kMostFused)));
}

/// 0: none is given
double given_step(const TrainGeometrySettings& settings, const TrainedSurfels& surfels) {
  if (settings.voxel_size > 0 || settings.grid_bits == 0) return settings.voxel_size;
  return 1.02 * extent_of(surfels, kFewOutside) / (std::pow(2.0, settings.grid_bits) - 1);
}

double sharpest_pixel(const Capture& capture, std::span<const int> cameras,
                      const TrainedSurfels& surfels) {
  std::vector<Float3> positions;
  for (const TrainedSurfel& surfel : surfels) positions.push_back(surfel.position());
  return pixel_on_surface(capture, cameras, positions, {});
}

}  // namespace

std::string training_obstacle(const Capture& capture, std::span<const int> cameras) {
  if (cameras.size() < kLeastTrainingCameras) return "too few cameras";
  if (capture.cloud.positions.size() < kLeastPoints) return "too few points";
  return {};
}

Result<TrainedGeometry, InputError> train_geometry(const Capture& capture,
                                                   std::span<const int> cameras,
                                                   const TrainGeometrySettings& settings,
                                                   TrainedSurfels trained,
                                                   const Progress& progress) {
  SLF_TRY(TrainingStart start, training_start(capture, cameras, settings, progress));
  if (start.views.empty()) return TrainedGeometry{};
  if (!trained.empty()) start.settings.from = kTrainedBefore;
  TrainedSurfels surfels = !trained.empty() ? std::move(trained) : first_surfels(start, settings);
  SLF_CHECK(train_surfels(start.views, start.settings, surfels));
  return geometry_of(std::move(surfels), capture, cameras, start.views, settings);
}

TrainedGeometry geometry_of(TrainedSurfels surfels, const Capture& capture,
                            std::span<const int> cameras, std::span<const TrainingView> views,
                            const TrainGeometrySettings& settings) {
  TrainedGeometry out;
  out.surfels = std::move(surfels);
  if (out.surfels.size() < kLeastPoints) return out;
  Lattice lattice;
  out.pixel = sharpest_pixel(capture, cameras, out.surfels);
  const double given = given_step(settings, out.surfels);
  const double automatic = automatic_step(out.surfels, out.pixel);
  lattice.step = given > 0 ? std::max(given, kFinest * automatic) : automatic;
  if (!(lattice.step > 0) || !std::isfinite(lattice.step)) return out;
  FuseSettings fusing;
  fusing.threads = settings.threads;
  SurfacePoints fused = fuse_surfels(out.surfels, views, lattice, fusing);
  if (fused.size() < kLeastFused) return out;
  out.cloud.positions = std::move(fused.positions);
  out.cloud.normals = std::move(fused.normals);
  out.voxel_size = given > 0 ? given : lattice.step;
  return out;
}

}  // namespace slf
