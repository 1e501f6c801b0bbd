// SPDX-License-Identifier: Apache-2.0
#include "encoder/compare_splats.h"

#include "base/stopwatch.h"
#include "encoder/encode_splats.h"
#include "encoder/fit/sampled_sight.h"
#include "encoder/train/train_gaussians.h"
#include "encoder/trial_file.h"

namespace slf {
namespace {

// dB of look_of: what a glance at splats may be below a quick fit. blender_can has -2.0, a lattice
// of rods 0.0, a translucent die +1.0.
constexpr double kPromise = 1;
// dB of worth that splats gain more than a surface does by the photographs that a trial has not
// seen and by the iterations that follow: a lattice 0.4, a die 0.6. docs/decisions/035
constexpr double kGoesOn = 0.5;
// dB that splats are above points after a quick fit, where nothing more is tried: a training gains
// 2.2 of the dino's hull, and has to come as near as splats_win().
constexpr double kBeyond = 6;
// dB of look_of that more splats than are tried at first may gain: a room 0.8, a can 0.9.
constexpr double kWithinReach = 1;

SplatJob splat_job(const SurfaceChoice& job, const CameraParts& parts) {
  return {job.capture,  job.report.start, parts.matched, parts.held_out,
          job.settings, job.progress,     job.cache};
}

}  // namespace

Result<DrawnQuality, InputError> judged(const SurfaceChoice& job, const CameraParts& parts,
                                        const VoxelCloud& cloud) {
  Stopwatch watch;
  auto quality =
      quick_quality(job.capture, parts.matched, parts.held_out, cloud, job.settings.threads);
  job.report.seconds_judge += watch.lap();
  return quality;
}

Result<Done, InputError> try_splats_once(const SurfaceChoice& job, const CameraParts& parts) {
  if (job.cache.tried) return Done{};
  Stopwatch watch;
  SLF_TRY(job.cache.tried, try_splats(splat_job(job, parts)));
  job.report.as_splats = job.cache.tried->file;
  job.report.seconds_train += watch.lap();
  return Done{};
}

Result<bool, InputError> splats_are_better(const SurfaceChoice& job, const CameraParts& parts,
                                           const VoxelCloud& surface, const DrawnQuality& quick) {
  SurfaceReport& report = job.report;
  if (report.as_splats.bytes == 0) return false;
  Stopwatch watch;
  if (splats_win(report, surface.positions.size())) return true;
  TrialFile splats = report.as_splats;
  if (look_of(splats) < look_of(quick)) {
    if (look_of(splats) < look_of(quick) - kWithinReach || !is_number_open(job.settings))
      return false;
    SLF_CHECK(find_splats_that_pay(splat_job(job, parts)));
    report.seconds_train += watch.lap();
    splats = job.cache.that_pay->best;
    report.more_splats = job.cache.that_pay->trials;
    if (look_of(splats) < look_of(quick)) return false;
  }
  SLF_TRY(report.as_surface, try_surface(job.capture, parts.matched, parts.held_out, surface,
                                         job.settings, job.progress));
  report.seconds_judge += watch.lap();
  return worth_of(splats) + kGoesOn > worth_of(report.as_surface);
}

Result<bool, InputError> exact_yields(const SurfaceChoice& job, const VoxelCloud& exact) {
  if (!job.splats) return false;
  const CameraParts parts = split_for_mending(job.cameras);
  SLF_TRY(const DrawnQuality quick, judged(job, parts, exact));
  Stopwatch watch;
  SLF_TRY(const TrialFile glance, glance_at_splats(splat_job(job, parts)));
  job.report.seconds_train += watch.lap();
  if (look_of(glance) < look_of(quick) - kPromise) return false;
  job.report.before_psnr = quick.psnr;
  SLF_CHECK(try_splats_once(job, parts));
  return splats_are_better(job, parts, exact, quick);
}

Result<Done, InputError> find_foreign(const SurfaceChoice& job, const PointCloud& trained) {
  if (!job.settings.check_cameras) return Done{};
  SLF_TRY(job.cache.foreign,
          foreign_photographs(job.capture, trained, job.cameras, job.settings.threads));
  return Done{};
}

Result<bool, InputError> splats_are_beyond(const SurfaceChoice& job, const CameraParts& parts,
                                           const DrawnQuality& quick) {
  job.report.before_psnr = quick.psnr;
  SLF_CHECK(try_splats_once(job, parts));
  if (job.report.as_splats.psnr < quick.psnr + kBeyond) return false;
  const auto shown = surface_of_splats_from({}, job.cache.tried->splats, job.capture, parts.matched,
                                            job.settings.threads);
  if (!shown) return false;
  SLF_CHECK(find_foreign(job, *shown));
  return true;
}

}  // namespace slf
