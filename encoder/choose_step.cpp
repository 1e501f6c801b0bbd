// SPDX-License-Identifier: Apache-2.0
#include "encoder/choose_step.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/stopwatch.h"
#include "codec/encoder/quantise_field.h"
#include "encoder/coding_parameters.h"
#include "encoder/component_planes.h"
#include "encoder/encode_to_target.h"
#include "encoder/rate_control.h"

namespace slf {
namespace {

constexpr std::size_t kFewestHeldOutPixels = 2000;

double psnr_of(double mean_squared_error) {
  return 10 * std::log10(255.0 * 255.0 / std::max(mean_squared_error, 1e-9));
}

/// dB that pictures of an error lose by noise which has nothing to do with it.
double loss_by(double noise, double error) { return psnr_of(error) - psnr_of(error + noise); }

/// Points of a sample, quantised as the coder would quantise the whole.
class SampleQuantiser {
 public:
  SampleQuantiser(const HeldOutPictures& pictures, const CaptureFit& fit, const Grid& grid,
                  std::size_t points, const EncoderSettings& settings)
      : pictures_(pictures),
        scale_(static_cast<double>(points) / static_cast<double>(pictures.positions().size())),
        settings_(settings) {
    settings_.normal_bits = 0;
    held_out_ = field_of(pictures.coefficients(), fit, grid);
    coded_ = field_of(pictures.coded(), fit, grid);
  }

  /// PSNR that the held-out pictures would have of what is coded, dB. Their own fit tells by how
  /// much a step helps or hurts where no camera was. But it has fewer cameras and less detail than
  /// the fit that is coded, which loses more: by noise of its own, twice to six times as much.
  Result<double, InputError> psnr(double q) {
    settings_.q = q;
    SLF_TRY(const std::vector<float> of_held_out, quantised(held_out_));
    SLF_TRY(const std::vector<float> of_coded, quantised(coded_));
    const double error = pictures_.mean_squared_error(pictures_.coefficients());
    const double known = pictures_.mean_squared_change(pictures_.coefficients(), of_held_out);
    const double noise = pictures_.mean_squared_change(pictures_.coded(), of_coded);
    const double more = loss_by(noise, error) - loss_by(known, error);
    return psnr_of(pictures_.mean_squared_error(of_held_out)) - std::max(more, 0.0);
  }

 private:
  LightField field_of(const std::vector<float>& coefficients, const CaptureFit& fit,
                      const Grid& grid) const {
    VoxelCloud cloud;
    cloud.grid = grid;
    cloud.positions = pictures_.positions();
    CaptureFit sample;
    sample.coefficients = coefficients;
    sample.gamma_min_q7 = fit.gamma_min_q7;
    sample.gamma_max_q7 = fit.gamma_max_q7;
    return quantise_grid(cloud, std::move(sample), {}, UpAxis::kUnknown, settings_);
  }
  Result<std::vector<float>, InputError> quantised(const LightField& field) const {
    SLF_TRY(const LightField decoded,
            quantise_field(field, coding_parameters(field, settings_), scale_));
    return decoded_coefficients(decoded, settings_.threads);
  }

  const HeldOutPictures& pictures_;
  double scale_;  // points that each of the sample stands for
  EncoderSettings settings_;
  LightField held_out_, coded_;
};

ChosenStep::Origin origin_without_pictures(const EncoderSettings& settings, std::size_t cameras) {
  if (settings.coefficients == CoefficientCoder::kTexture) return ChosenStep::kTexture;
  return cameras == 0 ? ChosenStep::kNoCameras : ChosenStep::kNoPictures;
}

}  // namespace

bool chooses_step(const EncoderSettings& settings, std::size_t cameras) {
  return settings.q == kAutomaticQ && !has_target(settings) && cameras > 0 &&
         settings.coefficients != CoefficientCoder::kTexture && settings.fit.pictures.rounds > 0;
}

Result<StepAndOrigin, InputError> choose_step(const EncoderSettings& settings,
                                              const CaptureFit& fit, const Grid& grid,
                                              std::size_t points, std::size_t cameras) {
  StepAndOrigin step{kPlainQ, {}};
  ChosenStep& chosen = step.chosen;
  chosen.origin = origin_without_pictures(settings, cameras);
  if (!fit.held_out) return step;
  const HeldOutPictures& pictures = *fit.held_out;
  chosen.origin = pictures.cameras() == 0 ? ChosenStep::kTooFewCameras : ChosenStep::kTooFewPixels;
  if (pictures.pixels() < kFewestHeldOutPixels) return step;
  Stopwatch watch;
  const double before = psnr_of(pictures.mean_squared_error(pictures.coefficients()));
  SampleQuantiser sample(pictures, fit, grid, points, settings);
  SLF_TRY(const StepFound found, find_largest_step(before, settings.quality_loss,
                                                   [&](double q) { return sample.psnr(q); }));
  step = {std::max(found.q, kPlainQ),
          {ChosenStep::kChosen, found.value, before, pictures.cameras(),
           pictures.positions().size(), 0}};
  if (found.q < kPlainQ) {
    SLF_TRY(const double at_least, sample.psnr(kPlainQ));
    chosen.loss = before - at_least;
  }
  chosen.seconds = pictures.seconds() + watch.lap();
  return step;
}

std::string reason_of(const ChosenStep& step) {
  char text[160];
  switch (step.origin) {
    case ChosenStep::kGiven:
      return "given";
    case ChosenStep::kChosen:
      std::snprintf(text, sizeof text,
                    "chosen: costs %.2f of %.2f dB of %zu input pictures held out from a fit of "
                    "%zu points",
                    step.loss, step.held_out, step.cameras, step.points);
      return text;
    case ChosenStep::kNoCameras:
      return "not chosen: there are no photographs to choose it by";
    case ChosenStep::kTexture:
      return "not chosen: the quality of a texture is its QP";
    case ChosenStep::kNoPictures:
      return "not chosen: nothing is fitted to pictures (--effort 1, --fit-to points, --fit paper)";
    case ChosenStep::kTooFewCameras:
      return "not chosen: there are too few photographs to hold some out";
    case ChosenStep::kTooFewPixels:
      return "not chosen: too little of the held-out photographs shows the points they are of";
    case ChosenStep::kSplats:
      return "not chosen: the usual step of splats";
  }
  return "";
}

}  // namespace slf
