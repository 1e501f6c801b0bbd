// SPDX-License-Identifier: Apache-2.0
// The encoder's main path: photographs and points to bytes. The last step is
// codec/encoder/pack.cpp.
#include <algorithm>
#include <optional>
#include <utility>

#include "base/release.h"
#include "base/stopwatch.h"
#include "capture/density.h"
#include "capture/photograph_size.h"
#include "codec/encoder/pack_frame.h"
#include "encoder/check_settings.h"
#include "encoder/choose_step.h"
#include "encoder/choose_surface.h"
#include "encoder/coding_parameters.h"
#include "encoder/encode_metadata.h"
#include "encoder/encode_splats.h"
#include "encoder/encode_to_target.h"
#include "encoder/encode_warnings.h"
#include "encoder/fit/match_exposure.h"
#include "encoder/fit/sampled_sight.h"
#include "encoder/fit_capture.h"
#include "encoder/other_start.h"
#include "encoder/train/refine_cameras.h"
#include "slf/encoder.h"

namespace slf {
namespace {

/// What stays while a step is looked for, and what came out last.
struct Job {
  const Capture& capture;
  std::span<const int> cameras;
  EncoderSettings settings;
  VoxelCloud cloud;
  CaptureFit fit;
  LightField field;
  Encoded encoded;
};

/// What does not depend on the step. The fit is given up.
void quantise(Job& job) {
  job.field = quantise_grid(job.cloud, std::move(job.fit), job.capture.origin, job.capture.up,
                            job.settings);  // 6.3, 6.5
  trim_heap();
}

/// Bytes with the step q.
/// @param last  no other step is tried: the field is given up
Result<Done, InputError> code(Job& job, double q, bool last) {
  job.encoded.q = job.settings.q = q;
  CodingParameters parameters = coding_parameters(job.field, job.settings);
  parameters.metadata = encoder_metadata(job.settings, job.encoded, job.cameras.size());
  SLF_TRY(job.encoded.stream, last ? pack_taken(std::move(job.field), parameters)
                                   : pack(job.field, parameters));  // spec 7, 8
  return Done{};
}

/// A step for settings without one. A target looks for its own, from the plain one on.
Result<Done, InputError> resolve_step(Job& job) {
  EncoderSettings& settings = job.settings;
  if (settings.q != kAutomaticQ) return Done{};
  if (has_target(settings)) {
    settings.q = kPlainQ;
    return Done{};
  }
  SLF_TRY(const StepAndOrigin step, choose_step(settings, job.fit, job.cloud.grid,
                                                job.cloud.positions.size(), job.cameras.size()));
  settings.q = step.q;
  job.encoded.step = step.chosen;
  job.fit.held_out.reset();
  return Done{};
}

/// What a person may want to know of the points that are coded.
void warn_of_points(Job& job) {
  Encoded& encoded = job.encoded;
  const bool automatic = job.settings.grid_bits == 0 && job.settings.voxel_size == 0;
  const bool trained = encoded.surface.kept == Surface::kTrained;  // as dense as it pays
  if (std::string warning = density_warning(encoded.density);
      automatic && !trained && !warning.empty())
    encoded.warnings.push_back(std::move(warning));
  if (std::string warning = merged_warning(job.cloud, job.capture.cloud.positions.size());
      automatic && encoded.surface.kept == Surface::kGiven && !warning.empty())
    encoded.warnings.push_back(std::move(warning));
  if (encoded.surface.mended.too_dense_for_grid && encoded.surface.kept == Surface::kGiven)
    encoded.warnings.push_back(
        "the cloud is denser than its photographs tell apart, and they disagree about it: on an "
        "automatic grid (no --grid-bits, no --voxel-size) it is thinned and mended");
}

/// Photographs that a training must not take in. What is not trained finds them in its fit.
Result<std::vector<CameraTrust>, InputError> foreign_to(const Capture& capture, StartId start,
                                                        std::span<const int> cameras,
                                                        const EncoderSettings& settings) {
  const bool trains = !cameras.empty() && settings.surface != Surface::kGiven;
  if (!settings.check_cameras || !trains || start != StartId::kPoints)
    return std::vector<CameraTrust>{};
  return foreign_photographs(capture, capture.cloud, cameras, settings.threads);
}

std::vector<int> without(std::span<const int> cameras, const std::vector<CameraTrust>& foreign) {
  std::vector<int> left;
  for (const int camera : cameras)
    if (std::none_of(foreign.begin(), foreign.end(),
                     [&](const CameraTrust& t) { return t.camera == camera; }))
      left.push_back(camera);
  return left;
}

/// What a file of splats says of photographs that were left out.
EncoderSettings with_dropped(EncoderSettings settings, const std::vector<CameraTrust>& foreign) {
  if (!foreign.empty())
    settings.metadata.emplace_back("cameras_dropped",
                                   cameras_with(CameraVerdict::kDropped, foreign));
  return settings;
}

void report_fit(Job& job) {
  Encoded& encoded = job.encoded;
  encoded.fit = job.fit.chosen;
  encoded.cameras.insert(encoded.cameras.end(), job.fit.cameras.begin(), job.fit.cameras.end());
  std::sort(encoded.cameras.begin(), encoded.cameras.end(),
            [](const CameraTrust& a, const CameraTrust& b) { return a.camera < b.camera; });
  encoded.observations = job.fit.observations;
  encoded.unobserved_points = job.fit.unobserved_points;
  encoded.seconds_observe = job.fit.seconds_observe;
  encoded.seconds_choose = job.fit.seconds_choose;
  encoded.seconds_fit = job.fit.seconds_fit;
  encoded.pictures = job.fit.pictures;
  encoded.seconds_pictures = job.fit.seconds_pictures;
}

/// Splats with what became of the surface before they were chosen.
Encoded with_choice(Encoded splats, const SurfaceReport& chosen) {
  SurfaceReport& report = splats.surface;
  report.mended = chosen.mended;
  report.before_psnr = chosen.before_psnr;
  report.trained_psnr = chosen.trained_psnr;
  report.as_splats = chosen.as_splats;
  report.as_surface = chosen.as_surface;
  report.seconds_train += chosen.seconds_train;
  report.seconds_judge += chosen.seconds_judge;
  return splats;
}

/// Photographs that are to be used, where there are some or something is made of them.
Result<Done, InputError> check_photographs_of(const Capture& capture, std::span<const int> cameras,
                                              Surface surface) {
  const auto refused = [](const std::string& what) {
    return InputError{Errc::kInvalidArgument, what};
  };
  if (!cameras.empty()) return Done{};
  if (!capture.cameras.empty()) return refused("none of the capture's cameras is to be used");
  if (surface == Surface::kAuto || surface == Surface::kGiven) return Done{};
  return refused(std::string("surface ") + word_of(surface) +
                 ": for photographs, and there are none");
}

Result<Encoded, InputError> encode_from(const Capture& capture, StartId start,
                                        std::span<const int> cameras,
                                        const std::vector<CameraTrust>& foreign,
                                        const EncoderSettings& given, const Progress& progress) {
  Job job{capture, cameras, given, {}, {}, {}, {}};
  EncoderSettings& settings = job.settings;
  Encoded& encoded = job.encoded;
  SLF_CHECK(check_photographs_of(capture, cameras, settings.surface));
  if (cameras.empty()) fit_colours_alone(settings);
  settings.observe.threads = settings.fit.threads = settings.threads;
  encoded.cameras = foreign;
  SLF_CHECK(check_settings(settings));
  SLF_CHECK(check_target(settings, cameras.size()));
  Stopwatch watch;
  TrainingCache cache;
  SLF_TRY(job.cloud, choose_surface(capture, cameras, settings, start, encoded.surface, progress,
                                    may_be_splats(given), &cache));
  if (!cache.foreign.empty()) {  // begin again without them
    std::vector<CameraTrust> all = foreign;
    all.insert(all.end(), cache.foreign.begin(), cache.foreign.end());
    return encode_from(capture, start, without(cameras, cache.foreign), all, given, progress);
  }
  std::optional<Capture> of_points;  // a mesh that other points took the place of hides nothing
  if (encoded.surface.kept != Surface::kGiven && !capture.mesh.triangles.empty()) {
    of_points = capture;
    of_points->mesh = {};
  }
  const Capture& seen = of_points ? *of_points : capture;
  if (encoded.surface.kept == Surface::kSplats) {
    SLF_TRY(Encoded splats,
            encode_splats(seen, start, cameras, with_dropped(given, foreign), progress, cache));
    splats.cameras = foreign;
    return with_choice(std::move(splats), encoded.surface);
  }
  encoded.points = job.cloud.positions.size();
  encoded.merged = job.cloud.merged;
  encoded.grid = moved(job.cloud.grid, capture.origin);
  encoded.density = job.cloud.density;
  warn_of_points(job);
  encoded.seconds_voxelise = watch.lap() - encoded.surface.seconds();
  SLF_TRY(job.fit,  // paper II, III-A
          cameras.empty() ? colours_alone(job.cloud)
                          : fit_capture(seen, cameras, job.cloud, settings, progress,
                                        chooses_step(settings, cameras.size())));
  if (!cameras.empty()) settings.fit = job.fit.chosen.settings;
  report_fit(job);
  if (!cameras.empty())
    SLF_CHECK(check_unseen(encoded.unobserved_points, encoded.points, encoded.warnings));
  SLF_CHECK(resolve_step(job));
  watch.lap();
  if (progress) progress("code", 0);
  quantise(job);
  const auto code_with = [&](double q) { return code(job, q, false); };
  SLF_CHECK(has_target(settings) ? code_to_target(settings, seen, cameras, code_with, encoded)
                                 : code(job, settings.q, true));
  encoded.seconds_code = watch.lap();
  if (progress) progress("code", 1);
  return std::move(job.encoded);
}

/// Cameras where photographs agree best, if they are to be moved.
Result<PoseReport, InputError> poses_of(const Capture& capture, StartId start,
                                        std::span<const int> cameras,
                                        const EncoderSettings& settings, const Progress& progress) {
  if (settings.refine_cameras == RefineCameras::kOff) return PoseReport{};
  const std::string obstacle =
      cameras.empty() ? "there are no photographs" : training_obstacle(capture, cameras);
  if (!obstacle.empty()) return InputError{Errc::kInvalidArgument, "refine-cameras: " + obstacle};
  return refine_cameras(capture, cameras, pose_training_of(settings, start), progress);
}

}  // namespace

Result<Encoded, InputError> encode(const Capture& given, std::span<const int> cameras,
                                   const EncoderSettings& settings, const Progress& progress) {
  SLF_CHECK(check_capture(given, cameras));
  const std::optional<Capture> within = photographs_within(given, settings.photograph_pixels);
  const Capture& capture = within ? *within : given;
  SLF_TRY(std::optional<StartingPoints> points, other_start(capture, cameras, settings));
  const bool splats = settings.surface == Surface::kSplats && !cameras.empty();
  const StartId start = points ? points->start : StartId::kPoints;
  std::optional<Capture> changed;
  if (points) {
    changed = capture;
    changed->cloud = std::move(points->cloud);
    changed->mesh = {};
  }
  const MatchExposure mode =
      start == StartId::kVolume ? MatchExposure::kOff : settings.match_exposure;
  SLF_TRY(ExposureReport exposure,
          match_exposure(changed ? *changed : capture, cameras, mode, settings.threads));
  EncoderSettings recorded = settings;
  if (!exposure.gains.empty()) {
    if (!changed) changed = capture;
    changed->gains = exposure.gains;
    recorded.metadata.emplace_back("exposure", "matched");
  }
  SLF_TRY(const std::vector<CameraTrust> foreign,
          foreign_to(changed ? *changed : capture, start, cameras, settings));
  const std::vector<int> own = without(cameras, foreign);
  SLF_TRY(PoseReport poses, poses_of(changed ? *changed : capture, start, own, settings, progress));
  if (!poses.cameras.empty()) {
    if (!changed) changed = capture;
    changed->cameras = poses.cameras;
    recorded.metadata.emplace_back("poses", "refined");
  }
  const Capture& seen = changed ? *changed : capture;
  TrainingCache cache;
  SLF_TRY(Encoded encoded,
          splats ? encode_splats(seen, start, own, with_dropped(recorded, foreign), progress, cache)
                 : encode_from(seen, start, own, foreign, recorded, progress));
  if (splats) encoded.cameras = foreign;
  if (points && points->left_out > 0)
    encoded.warnings.push_back(left_out_warning(points->left_out, capture.cloud.positions.size()));
  warn_of_cameras(encoded.cameras, cameras.size(), capture, encoded.warnings);
  if (settings.match_exposure == MatchExposure::kOn && exposure.gains.empty() && !cameras.empty())
    encoded.warnings.push_back(
        "exposure is not matched: photographs have no points in common to compare");
  encoded.exposure = std::move(exposure);
  encoded.poses = std::move(poses);
  return encoded;
}

}  // namespace slf
