// SPDX-License-Identifier: Apache-2.0
#include "encoder/trial_file.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "encoder/choose_step.h"
#include "encoder/coding_parameters.h"
#include "encoder/fit_capture.h"
#include "encoder/rate_control.h"
#include "slf/decoder.h"

namespace slf {
namespace {

constexpr double kDoubling = 0.5;  // dB that twice the bytes have to gain: docs/decisions/035
constexpr double kTrialTolerance = 0.03;  // of a target in bytes

/// With the step, or with one whose bytes are the target's, as nearly as a trial has to know.
Result<std::vector<std::uint8_t>, InputError> coded_field(const LightField& field,
                                                          EncoderSettings settings) {
  if (settings.target_bytes == 0) return pack(field, coding_parameters(field, settings));
  std::vector<std::uint8_t> stream;
  const auto log_bytes = [&](double q) -> Result<double, InputError> {
    settings.q = q;
    SLF_TRY(stream, pack(field, coding_parameters(field, settings)));
    return std::log(stream.size());
  };
  const double target = std::log(settings.target_bytes);
  SLF_CHECK(find_step(kPlainQ, {target - kTrialTolerance, target + kTrialTolerance}, log_bytes));
  return stream;
}

/// Mean of PSNR and of SSIM in decibels.
double mean_look(double psnr, double ssim) {
  return (psnr - 10 * std::log10(std::max(1 - ssim, 1e-6))) / 2;
}

}  // namespace

double look_of(const DrawnQuality& drawn) {
  const double all = mean_look(drawn.psnr, drawn.ssim);
  return drawn.inside_psnr > 0 ? (all + mean_look(drawn.inside_psnr, drawn.inside_ssim)) / 2 : all;
}

double look_of(const TrialFile& file) {
  return look_of(DrawnQuality{file.psnr, file.ssim, file.inside_psnr, file.inside_ssim});
}

TrialFile trial_of(const DrawnQuality& drawn, std::size_t bytes) {
  return {drawn.psnr, drawn.ssim, bytes, drawn.inside_psnr, drawn.inside_ssim};
}

double worth_of(const TrialFile& file) {
  return look_of(file) - kDoubling * std::log2(double(std::max<std::size_t>(file.bytes, 1)));
}

Result<TrialFile, InputError> try_surface(const Capture& capture, std::span<const int> fitted,
                                          std::span<const int> held_out, const VoxelCloud& cloud,
                                          const EncoderSettings& settings,
                                          const Progress& progress) {
  EncoderSettings trial = settings;
  const bool directions = trial.search.directions;
  const std::size_t points = trial.search.points;
  trial.search = FitSearch::none();
  trial.search.directions = directions;
  trial.search.points = points;
  SLF_TRY(CaptureFit fit,
          fit_capture(capture, fitted, cloud, trial, progress, chooses_step(trial, fitted.size())));
  trial.fit = fit.chosen.settings;
  SLF_TRY(const StepAndOrigin step,
          choose_step(trial, fit, cloud.grid, cloud.positions.size(), fitted.size()));
  // With all photographs there is more that a step can lose: of a die it is a third.
  trial.q = std::max(step.q / 2, kPlainQ);
  fit.held_out.reset();
  const LightField field = quantise_grid(cloud, std::move(fit), capture.origin, capture.up, trial);
  SLF_TRY(const auto stream, coded_field(field, trial));
  DecodeOptions options;
  options.threads = trial.threads;
  options.limits = DecodeLimits::none();
  const auto decoded = decode(stream, options);
  if (!decoded) return InputError{decoded.error().code, "a trial file does not decode"};
  SLF_TRY(const DrawnQuality quality, surface_quality(capture, held_out, *decoded, trial.threads));
  return trial_of(quality, stream.size());
}

}  // namespace slf
