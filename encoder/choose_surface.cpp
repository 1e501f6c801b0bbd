// SPDX-License-Identifier: Apache-2.0
#include "encoder/choose_surface.h"

#include <algorithm>
#include <utility>

#include "base/stopwatch.h"
#include "encoder/compare_splats.h"
#include "encoder/fit_capture.h"
#include "encoder/judge_surface.h"
#include "encoder/other_start.h"
#include "encoder/refine/held_out.h"
#include "encoder/refine/refine_geometry.h"
#include "encoder/train/train_geometry.h"

namespace slf {
namespace {

constexpr double kLeastGain = 0.1;  // dB, for which a trained surface takes the place of another
constexpr double kPerfect = 48;     // dB: errors of a grey level; what is gained there is nothing
constexpr int kIterations = 2500;
constexpr double kAgain = 1.0 / 6;  // of the time: with all photographs, after some of them

/// @param before  trained by some of the cameras, or empty
/// @param share  of the time that may be taken
Result<TrainedGeometry, InputError> trained_by(const SurfaceChoice& job,
                                               std::span<const int> cameras, TrainedSurfels before,
                                               double share) {
  Stopwatch watch;
  TrainGeometrySettings training;
  training.grid_bits = job.settings.grid_bits;
  training.voxel_size = job.settings.voxel_size;
  training.iterations = kIterations;
  training.threads = job.settings.threads;
  training.work = job.settings.work;
  training.resume = job.settings.resume;
  training.seconds = share * job.settings.surface_seconds;
  training.photograph_bytes = double(job.settings.surface_memory) * (1 << 20);
  training.is_volume = job.report.start == StartId::kVolume;
  training.cache = &job.cache;
  auto trained = train_geometry(job.capture, cameras, training, std::move(before), job.progress);
  job.report.seconds_train += watch.lap();
  if (trained) job.report.surfels = trained->surfels.size();
  return trained;
}

Result<VoxelCloud, InputError> on_grid(const TrainedGeometry& trained) {
  SLF_TRY(VoxelCloud cloud, voxelise(trained.cloud, 0, trained.voxel_size));
  cloud.density.pixel = trained.pixel;
  cloud.density.spacing = cloud.density.voxel_size = trained.voxel_size;
  return cloud;
}

Result<VoxelCloud, InputError> taken(const SurfaceChoice& job, const TrainedGeometry& trained) {
  job.report.kept = Surface::kTrained;
  return on_grid(trained);
}

VoxelCloud no_surface(const SurfaceChoice& job) {
  job.report.kept = Surface::kSplats;
  return {};
}

/// A surface that three quarters of the photographs train; where the others say that it pays, all.
/// Or splats.
Result<VoxelCloud, InputError> best_of(const SurfaceChoice& job, VoxelCloud before) {
  const CameraParts parts = split_for_mending(job.cameras);
  SLF_TRY(const DrawnQuality before_quality, judged(job, parts, before));
  job.report.before_psnr = before_quality.psnr;
  if (before_quality.psnr > kPerfect) return before;
  if (job.splats && is_dense(job.capture, job.cameras)) {
    SLF_TRY(const bool beyond, splats_are_beyond(job, parts, before_quality));
    if (beyond) return no_surface(job);
  }
  SLF_TRY(TrainedGeometry trained, trained_by(job, parts.matched, {}, 1 - kAgain));
  if (trained.cloud.positions.empty()) {
    job.report.untrained = "photographs agree on no surface";
    return before;
  }
  const auto cloud = on_grid(trained);
  if (!cloud) {
    job.report.untrained = cloud.error().message;
    return before;
  }
  SLF_CHECK(find_foreign(job, trained.cloud));
  if (!job.cache.foreign.empty()) return before;
  SLF_TRY(const DrawnQuality trained_quality, judged(job, parts, *cloud));
  job.report.trained_psnr = trained_quality.psnr;
  const bool pays = job.report.trained_psnr >= job.report.before_psnr + kLeastGain;
  if (job.splats) SLF_CHECK(try_splats_once(job, parts));
  SLF_TRY(const bool better, splats_are_better(job, parts, pays ? *cloud : before,
                                               pays ? trained_quality : before_quality));
  if (better) return no_surface(job);
  if (!pays) return before;
  SLF_TRY(const TrainedGeometry by_all,
          trained_by(job, job.cameras, std::move(trained.surfels), kAgain));
  if (by_all.cloud.positions.empty()) return before;
  return taken(job, by_all);
}

/// Points of a volume are no surface: there is nothing to compare with.
Result<VoxelCloud, InputError> only_trained(const SurfaceChoice& job) {
  const auto refuse = [](const std::string& why) {
    return InputError{Errc::kInvalidInput, "the capture has no points, and " + why +
                                               ": give points, as of COLMAP (--points)"};
  };
  const Surface asked = job.settings.surface;
  if (asked == Surface::kGiven || asked == Surface::kMended)
    return refuse("a surface is to be trained (--surface trained)");
  if (!job.report.untrained.empty()) return refuse(job.report.untrained);
  SLF_TRY(const TrainedGeometry trained, trained_by(job, job.cameras, {}, 1));
  if (trained.cloud.positions.empty()) return refuse("photographs agree on no surface");
  return taken(job, trained);
}

/// Whether points that are not exact are worth mending: not where splats are beyond them.
Result<bool, InputError> mending_pays(const SurfaceChoice& job) {
  if (!job.splats || !job.report.untrained.empty() || !is_dense(job.capture, job.cameras))
    return true;
  const CameraParts parts = split_for_mending(job.cameras);
  SLF_TRY(const VoxelCloud given, voxelise_capture(job.capture, job.cameras, job.settings));
  SLF_TRY(const DrawnQuality quick, judged(job, parts, given));
  SLF_TRY(const bool beyond, splats_are_beyond(job, parts, quick));
  return !beyond;
}

/// The capture's points, or mended ones where photographs gain.
Result<VoxelCloud, InputError> given_or_mended(const SurfaceChoice& job, RefineGeometry mode) {
  const auto pays = [&job] { return mending_pays(job); };
  const double before = job.report.seconds_train + job.report.seconds_judge;
  SLF_TRY(VoxelCloud cloud, voxelise_mended(job.capture, job.cameras, job.settings, mode, pays,
                                            job.report.mended, job.progress));
  // What it took to see whether it pays is counted where that was done.
  job.report.mended.seconds -= job.report.seconds_train + job.report.seconds_judge - before;
  if (job.report.mended.outcome == RefineReport::kMended) job.report.kept = Surface::kMended;
  return cloud;
}

/// A capture with points, its own or a mesh's.
Result<VoxelCloud, InputError> chosen_from_points(const SurfaceChoice& job) {
  const Surface asked = job.cameras.empty() ? Surface::kGiven : job.settings.surface;
  if (asked == Surface::kGiven) return given_or_mended(job, RefineGeometry::kOff);
  if (asked == Surface::kMended) return given_or_mended(job, RefineGeometry::kOn);
  job.report.untrained = training_obstacle(job.capture, job.cameras);
  if (asked == Surface::kTrained && job.report.untrained.empty()) {
    SLF_TRY(const TrainedGeometry trained, trained_by(job, job.cameras, {}, 1));
    if (!trained.cloud.positions.empty()) return taken(job, trained);
    job.report.untrained = "photographs agree on no surface";
  }
  SLF_TRY(VoxelCloud before, given_or_mended(job, RefineGeometry::kAuto));
  if (job.report.mended.outcome == RefineReport::kOutdone) return no_surface(job);
  if (asked == Surface::kTrained || !job.report.untrained.empty()) return before;
  if (job.report.mended.exact && is_dense(job.capture, job.cameras)) {
    SLF_TRY(const bool yields, exact_yields(job, before));
    if (yields) return no_surface(job);
    job.report.untrained = "the points lie where photographs agree";
    return before;
  }
  return best_of(job, std::move(before));
}

/// Points of a mesh are judged as a cloud's are. Where they stay as they are, the mesh itself is
/// put on the grid.
Result<VoxelCloud, InputError> chosen_from_mesh(const SurfaceChoice& job) {
  Capture points = job.capture;
  points.mesh = {};
  SLF_TRY(VoxelCloud cloud, chosen_from_points({points, job.cameras, job.settings, job.report,
                                                job.progress, job.cache, job.splats}));
  if (job.report.kept != Surface::kGiven) return cloud;
  return voxelise_capture(job.capture, job.cameras, job.settings);
}

Result<VoxelCloud, InputError> chosen_surface(const SurfaceChoice& job) {
  if (job.report.start == StartId::kVolume) {
    job.report.untrained = training_obstacle(job.capture, job.cameras);
    return only_trained(job);
  }
  const bool mesh = !job.capture.mesh.triangles.empty();
  return mesh && !job.cameras.empty() && job.settings.surface != Surface::kGiven
             ? chosen_from_mesh(job)
             : chosen_from_points(job);
}

}  // namespace

Result<VoxelCloud, InputError> choose_surface(const Capture& capture, std::span<const int> cameras,
                                              const EncoderSettings& settings, StartId start,
                                              SurfaceReport& report, const Progress& progress,
                                              bool splats, TrainingCache* cache) {
  TrainingCache own;
  report = {};
  report.start = start;
  report.points_before = capture.cloud.positions.size();
  auto cloud = chosen_surface(
      {capture, cameras, settings, report, progress, cache != nullptr ? *cache : own, splats});
  if (cloud) report.points_after = cloud->positions.size();
  if (progress) progress("train", 1);
  return cloud;
}

}  // namespace slf
