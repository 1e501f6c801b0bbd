// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/splats_in_time.h"

#include <algorithm>
#include <utility>

#include "encoder/train/changed_views.h"
#include "encoder/train/outlines.h"
#include "encoder/train/train_gaussians.h"
#include "encoder/train/train_surfels.h"
#include "encoder/train/training_start.h"

namespace slf {
namespace {

constexpr int kIterationsOfChange = 1500;  // decision 056
constexpr double kMoreSplats = 1.25;       // of those of the first frame, where things appear
constexpr float kFaintest = 0.004f;        // fainter than any pixel shows

/// Another origin, and what the surfels show in place of the capture's points.
Capture on_surfels(const Capture& capture, const Vec3& origin, const TrainedSurfels& surfels) {
  Capture out = capture;
  Vec3 shift{};
  for (std::size_t k = 0; k < 3; ++k) shift[k] = capture.origin[k] - origin[k];
  for (Camera& camera : out.cameras) camera = moved(camera, shift);
  out.origin = origin;
  out.mesh = {};
  out.cloud = {};
  for (const TrainedSurfel& surfel : surfels) {
    out.cloud.positions.push_back(surfel.position());
    out.cloud.normals.push_back(axes_of(surfel).normal);
  }
  return out;
}

/// keep_object of those that move.
void keep_moving_in(const std::vector<Outline>& outlines, const std::vector<std::uint8_t>& moving,
                    int threads, TrainedSurfels& surfels) {
  TrainedSurfels still, moved;
  for (std::size_t i = 0; i < surfels.size(); ++i)
    (moving[i] ? moved : still).push_back(surfels[i]);
  keep_object(outlines, threads, moved);
  still.insert(still.end(), moved.begin(), moved.end());
  surfels = std::move(still);
}

}  // namespace

Result<Done, InputError> SplatsInTime::begin(const Capture& capture, std::span<const int> cameras,
                                             const Progress& progress) {
  origin_ = capture.origin;
  settings_.cache = &cache_;
  SLF_TRY(surfels_, train_gaussian_surfels(capture, cameras, settings_, progress));
  return Done{};
}

Result<Done, InputError> SplatsInTime::go_on(const Capture& capture, std::span<const int> cameras,
                                             const Progress& progress) {
  TrainGeometrySettings settings = settings_;
  settings.iterations = kIterationsOfChange;
  settings.is_volume = false;
  settings.surfels = static_cast<std::size_t>(kMoreSplats * static_cast<double>(surfels_.size()));
  cache_.normals.clear();  // those of the points of the first
  SLF_TRY(TrainingStart start, training_start(capture, cameras, settings, progress));
  if (start.views.empty()) return Done{};
  if (before_.empty()) {
    before_ = std::move(start.views);
    return Done{};
  }
  const ChangedViews changed(before_, std::move(start.views), settings.threads);
  if (changed.views().empty()) return Done{};
  std::vector<TrainingView> views = changed.views();
  train_as_gaussians(views, start.settings);
  start.settings.changed = &changed;
  start.settings.least_opacity = kFaintest;
  SLF_CHECK(train_surfels(views, start.settings, surfels_));
  if (!cache_.outlined) return Done{};
  SLF_TRY(const std::vector<Outline> outlines, outlines_of(capture, cameras, settings.threads));
  if (are_outlined(outlines.size(), cameras.size()))
    keep_moving_in(outlines, changed.shown_by(surfels_, settings.threads), settings.threads,
                   surfels_);
  return Done{};
}

Result<Gaussians, InputError> SplatsInTime::next(const Capture& capture,
                                                 std::span<const int> cameras,
                                                 const Progress& progress) {
  const bool first = surfels_.empty();
  if (first) SLF_CHECK(begin(capture, cameras, progress));
  if (surfels_.empty()) return Gaussians{};
  // The first one's photographs are looked at once more, as those to compare with.
  SLF_CHECK(go_on(on_surfels(capture, origin_, surfels_), cameras, progress));
  Gaussians out = gaussians_of(surfels_);
  out.up = capture.up;
  return out;
}

}  // namespace slf
