// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/splats_in_time.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "capture/nearest.h"
#include "capture/spacing.h"
#include "encoder/measure/outlines.h"
#include "encoder/train/changed_views.h"
#include "encoder/train/empty_pixels.h"
#include "encoder/train/starting_points.h"
#include "encoder/train/train_gaussians.h"
#include "encoder/train/train_surfels.h"
#include "encoder/train/training_start.h"

namespace slf {
namespace {

constexpr int kIterationsOfChange = 1500;  // decision 056
constexpr double kMoreSplats = 1.5;        // of those of the first frame, where things appear
constexpr float kNewReach = 1.5f;          // spacings: points so far from every surfel are new
constexpr std::size_t kFewestNew = 20;     // points: fewer are the hull's own noise

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

/// Points of this instant where no surfel is: something has appeared there.
SurfacePoints points_apart(const PointCloud& cloud, const TrainedSurfels& surfels, float apart) {
  std::vector<Float3> known;
  for (const TrainedSurfel& surfel : surfels) known.push_back(surfel.position());
  const NearestPoints nearest(known);
  SurfacePoints out;
  for (std::size_t p = 0; p < cloud.positions.size(); ++p) {
    std::uint32_t index = 0;
    float square = 0;
    nearest.nearest(cloud.positions[p], 1, &index, &square);
    const TrainedSurfel& there = surfels[index];
    const float reach = apart + std::max(there.radius(0), there.radius(1));
    if (square < reach * reach) continue;
    out.positions.push_back(cloud.positions[p]);
    out.normals.push_back(cloud.normals[p]);
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
  first_ = surfels_.size();
  return Done{};
}

Result<Done, InputError> SplatsInTime::add_what_appears(const Capture& capture,
                                                        std::span<const int> cameras,
                                                        const ChangedViews& changed) {
  const auto most = static_cast<std::size_t>(kMoreSplats * static_cast<double>(first_));
  if (!cache_.outlined || surfels_.size() >= most) return Done{};
  const auto hull = starting_points(capture, cameras, settings_.threads);
  if (!hull || hull->start != StartId::kHull) return Done{};  // nothing is cut out this time
  const double spacing = typical_spacing(hull->cloud.positions);
  const SurfacePoints fresh =
      points_apart(hull->cloud, surfels_, kNewReach * static_cast<float>(spacing));
  if (fresh.size() < kFewestNew) return Done{};
  const std::size_t before = surfels_.size();
  const TrainedSurfels added = start_surfels(fresh, spacing, changed.views(), most - before,
                                             kSolidOpacity, settings_.threads);
  surfels_.insert(surfels_.end(), added.begin(), added.end());
  const std::vector<std::uint8_t> shown = changed.shown_by(surfels_, settings_.threads);
  std::size_t kept = before;
  for (std::size_t i = before; i < surfels_.size(); ++i)
    if (shown[i]) surfels_[kept++] = surfels_[i];
  surfels_.resize(kept);
  return Done{};
}

Result<Done, InputError> SplatsInTime::go_on(const Capture& capture, std::span<const int> cameras,
                                             const Progress& progress) {
  TrainGeometrySettings settings = settings_;
  settings.iterations = kIterationsOfChange;
  settings.is_volume = false;
  cache_.normals.clear();  // those of the points of the first
  cache_.views.clear();    // the light may have changed, cameras may have moved
  SLF_TRY(TrainingStart start, training_start(capture, cameras, settings, progress));
  if (start.views.empty()) return Done{};
  train_as_gaussians(false, start.views, start.settings);
  if (cache_.outlined) SLF_CHECK(charge_for_hiding(capture, settings.threads, start.views));
  const auto name = [&](int camera) { return capture.cameras[std::size_t(camera)].name; };
  if (before_.empty()) {
    for (TrainingView& view : start.views) before_[name(view.index)] = std::move(view);
    return Done{};
  }
  std::vector<std::string> names;
  std::vector<TrainingView> before;  // none of a camera that shows its first photograph
  for (const TrainingView& view : start.views) {
    names.push_back(name(view.index));
    before.push_back(std::move(before_[names.back()]));
  }
  const ChangedViews changed(before, std::move(start.views), settings.threads);
  for (std::size_t i = 0; i < names.size(); ++i) before_[names[i]] = std::move(before[i]);
  if (changed.views().empty()) return Done{};
  SLF_CHECK(add_what_appears(capture, cameras, changed));
  start.settings.surfels = std::max(first_, surfels_.size());
  start.settings.changed = &changed;
  SLF_CHECK(train_surfels(changed.views(), start.settings, surfels_));
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
