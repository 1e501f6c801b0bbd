// SPDX-License-Identifier: Apache-2.0
#include "encoder/encode_splats.h"

#include <algorithm>
#include <string>
#include <utility>

#include "base/stopwatch.h"
#include "encoder/encode_metadata.h"
#include "encoder/encode_to_target.h"
#include "encoder/gaussian_coding.h"
#include "encoder/judge_surface.h"
#include "encoder/middle_view.h"
#include "encoder/refine/held_out.h"
#include "encoder/train/train_gaussians.h"
#include "encoder/trial_file.h"
#include "slf/encode_gaussians.h"
#include "slf/gaussian_renderer.h"

namespace slf {
namespace {

constexpr int kPoseIterations = 3000;
constexpr int kSplatIterations = 6000, kTrialIterations = 3000, kGlanceIterations = 600;
// dB, of splats, which are judged as they will be drawn, over a surface that is judged by a quick
// fit: of 4.0 of the dino 2.1 are left (1.3 within the object), of 3.5 of a vase 0.3 (-0.1).
constexpr double kSplatGain = 3.5;
constexpr double kSurfaceBytes = 0.6;  // a point of a surface, about: less than splats may take
constexpr double kSplatBytes = 13;     // at Q 6.5, of a die, a vase and the dino: 11 to 17
constexpr double kMoreSplats = 1.75;   // times as many as in the trial before
constexpr double kMoreWorth = 0.1;     // dB that these have to gain, which is chance
constexpr double kPromising = 0.2;     // the next ones gain less than half as much
constexpr double kTaught = 0.75;       // of the splats asked for: photographs teach no more
// Fewer are trained for longer, twice at most: docs/decisions/073.
constexpr double kUsualSplats = 4000, kLonger = 2;

TrainGeometrySettings training_of(const EncoderSettings& settings, StartId start, int iterations,
                                  TrainingCache& cache) {
  TrainGeometrySettings training;
  training.iterations = iterations;
  training.threads = settings.threads;
  training.work = settings.work;
  training.resume = settings.resume;
  training.seconds = settings.surface_seconds;
  training.photograph_bytes = double(settings.surface_memory) * (1 << 20);
  training.is_volume = start == StartId::kVolume;
  if (settings.splats > 0)
    training.surfels = settings.splats;
  else if (settings.target_bytes > 0)
    training.surfels =
        std::max(std::size_t(double(settings.target_bytes) / kSplatBytes), kFewestSplats);
  training.cache = &cache;
  return training;
}

/// @param splats  that are asked for; 0: as many as ever
int final_iterations(std::size_t splats) {
  const double longer = splats > 0 ? std::clamp(kUsualSplats / double(splats), 1.0, kLonger) : 1;
  return int(longer * kSplatIterations);
}

/// What a decoder draws of the splats.
Result<TrialFile, InputError> coded_splats(const Gaussians& splats, const Capture& capture,
                                           std::span<const int> held_out,
                                           const EncoderSettings& settings) {
  SLF_TRY(const EncodedGaussians file, encode_gaussians(splats, coding_of_splats(settings)));
  SLF_TRY(const Gaussians shown, decoded_gaussians(file.stream, settings.threads));
  const GaussianRenderer renderer(shown, {.background = {0, 0, 0}, .threads = 1});
  SLF_TRY(const DrawnQuality quality,
          pictures_quality(
              capture, held_out, [&](const Camera& camera) { return renderer.render(camera); },
              settings.threads));
  return trial_of(quality, file.stream.size());
}

/// @param splats  at most; 0: as ever
Result<SplatTrial, InputError> tried(const SplatJob& job, int iterations, std::size_t splats = 0) {
  SplatTrial trial;
  TrainGeometrySettings training = training_of(job.settings, job.start, iterations, job.cache);
  if (splats > 0) training.surfels = splats;
  SLF_TRY(trial.splats, train_gaussians(job.capture, job.fitted, training, job.progress));
  if (trial.splats.size() == 0) return trial;
  auto file = coded_splats(trial.splats, job.capture, job.held_out, job.settings);
  if (!file && file.error().code != Errc::kInvalidInput) return file.error();
  if (!file) return SplatTrial{};  // no file of them that can be drawn: nothing to choose
  trial.file = *file;
  trial.file.splats = trial.splats.size();
  return trial;
}

/// @param tried_first  of as many as ever
Result<SplatsThatPay, InputError> more_and_more(const SplatJob& job, const TrialFile& tried_first) {
  SplatsThatPay out;
  out.best = tried_first;
  for (double gain = kPromising; out.best.bytes > 0 && gain >= kPromising;) {
    const auto more = static_cast<std::size_t>(kMoreSplats * double(out.best.splats));
    SLF_TRY(const SplatTrial trial, tried(job, kTrialIterations, more));
    if (trial.file.bytes == 0) break;
    out.trials.push_back(trial.file);
    gain = worth_of(trial.file) - worth_of(out.best);
    if (gain < kMoreWorth) break;
    out.number = more;
    out.best = trial.file;
    if (double(out.best.splats) < kTaught * double(more)) break;
  }
  return out;
}

}  // namespace

TrainGeometrySettings pose_training_of(const EncoderSettings& settings, StartId start) {
  TrainingCache none;
  TrainGeometrySettings training = training_of(settings, start, kPoseIterations, none);
  training.surfels = 0;
  training.cache = nullptr;
  return training;
}

TrainGeometrySettings training_of_frames(const EncoderSettings& settings) {
  TrainingCache none;
  TrainGeometrySettings training = training_of(settings, StartId::kPoints, kSplatIterations, none);
  training.work.clear();
  training.cache = nullptr;
  return training;
}

EncoderSettings coding_of_splats(EncoderSettings settings) {
  if (settings.q == kAutomaticQ) settings.q = kTrainedGaussianQ;
  if (settings.rdo == kAutomaticRdo) settings.rdo = 1;
  return settings;
}

bool may_be_splats(const EncoderSettings& settings) {
  const EncoderSettings plain;
  return settings.surface == Surface::kAuto && settings.preset == plain.preset &&
         settings.q == kAutomaticQ && !(settings.target_psnr > 0) && settings.grid_bits == 0 &&
         settings.voxel_size == 0 && settings.coefficients == plain.coefficients &&
         settings.geometry == plain.geometry && settings.transform == plain.transform &&
         settings.normal_bits == 0 && settings.quality_loss == plain.quality_loss;
}

bool splats_win(const SurfaceReport& report, std::size_t points) {
  const double best = std::max(report.before_psnr, report.trained_psnr);
  return report.as_splats.psnr > best + kSplatGain &&
         double(report.as_splats.bytes) < kSurfaceBytes * double(points);
}

Result<SplatTrial, InputError> try_splats(const SplatJob& job) {
  return tried(job, kTrialIterations);
}

bool is_number_open(const EncoderSettings& settings) {
  return settings.splats == 0 && !(settings.surface_seconds > 0) && !has_target(settings);
}

Result<Done, InputError> find_splats_that_pay(const SplatJob& job) {
  TrainingCache& cache = job.cache;
  if (cache.that_pay) return Done{};
  if (!cache.tried) {
    SLF_TRY(cache.tried, try_splats(job));
  }
  SLF_TRY(cache.that_pay, more_and_more(job, cache.tried->file));
  return Done{};
}

Result<TrialFile, InputError> glance_at_splats(const SplatJob& job) {
  SLF_TRY(const SplatTrial trial, tried(job, kGlanceIterations));
  return trial.file;
}

Result<Encoded, InputError> encode_splats(const Capture& capture, StartId start,
                                          std::span<const int> cameras,
                                          const EncoderSettings& settings, const Progress& progress,
                                          TrainingCache& cache) {
  const std::string obstacle =
      cameras.empty() ? "there are no photographs" : training_obstacle(capture, cameras);
  if (!obstacle.empty())
    return InputError{Errc::kInvalidInput, "splats are trained by photographs: " + obstacle};
  SLF_CHECK(check_target(settings, cameras.size()));
  Encoded out;
  out.surface.start = start;
  out.surface.kept = Surface::kSplats;
  out.surface.points_before = capture.cloud.positions.size();
  Stopwatch watch;
  TrainGeometrySettings training = training_of(settings, start, kSplatIterations, cache);
  const CameraParts parts = split_for_mending(cameras);
  if (is_number_open(settings) && !parts.held_out.empty()) {
    SLF_CHECK(find_splats_that_pay(
        {capture, start, parts.matched, parts.held_out, settings, progress, cache}));
    training.surfels = cache.that_pay->number;
    out.surface.as_splats = cache.tried->file;
    out.surface.more_splats = cache.that_pay->trials;
  }
  training.iterations = final_iterations(training.surfels);
  SLF_TRY(const Gaussians splats, train_gaussians(capture, cameras, training, progress));
  out.surface.seconds_train = watch.lap();
  if (splats.size() == 0)
    return InputError{Errc::kInvalidInput, "photographs agree on nothing: no splat was left"};
  EncoderSettings coding = coding_of_splats(settings);
  coding.metadata.insert(coding.metadata.begin(), {{"surface", word_of(Surface::kSplats)},
                                                   {"cameras", std::to_string(cameras.size())}});
  add_middle_view(capture, cameras, cache, settings.metadata, coding.metadata);
  if (progress) progress("code", 0);
  coding.target_bytes = 0;
  coding.target_psnr = 0;
  if (settings.q == kAutomaticQ && !has_target(settings)) out.step.origin = ChosenStep::kSplats;
  const auto code = [&](double q) -> Result<Done, InputError> {
    EncoderSettings with = coding;
    with.q = q;
    SLF_TRY(EncodedGaussians coded, encode_gaussians(splats, with, capture.origin));
    out.stream = std::move(coded.stream);
    out.q = coded.q;
    out.grid = coded.grid;
    out.points = out.surface.points_after = out.surface.surfels = coded.splats;
    return Done{};
  };
  if (has_target(settings)) {
    EncoderSettings target = settings;
    target.q = coding.q;
    SLF_CHECK(code_to_target(target, capture, cameras, code, out));
  } else {
    SLF_CHECK(code(coding.q));
  }
  out.seconds_code = watch.lap();
  if (progress) progress("code", 1);
  return out;
}

}  // namespace slf
