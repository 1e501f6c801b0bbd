// SPDX-License-Identifier: Apache-2.0
#include "encoder/encode_to_target.h"

#include <cmath>
#include <cstdio>

#include "encoder/rate_control.h"
#include "slf/decoder.h"
#include "slf/evaluate.h"
#include "slf/gaussian_renderer.h"

namespace slf {
namespace {

constexpr double kByteTolerance = 0.01, kPsnrTolerance = 0.05;

std::string decimals(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.2f", value);
  return buffer;
}

/// PSNR of the input images in what a decoder gets, dB: of pictures or of points, whatever the fit
/// is to.
Result<double, InputError> input_psnr(std::span<const std::uint8_t> stream, const Capture& capture,
                                      std::span<const int> cameras,
                                      const EncoderSettings& settings) {
  DecodeOptions options;
  options.threads = settings.threads;
  options.limits = DecodeLimits::none();
  const auto decoded = decode(stream, options);
  if (!decoded) return InputError{decoded.error().code, "target PSNR: the file does not decode"};
  EvaluateSettings evaluation;
  evaluation.threads = settings.threads;
  if (has_gaussians(decoded->header)) {
    SLF_TRY(const Gaussians splats, gaussians_of(*decoded, settings.threads));
    const GaussianRenderer renderer(splats, {.background = {0, 0, 0}, .threads = 1});
    const auto draw = [&](const Camera& camera) { return renderer.render(camera); };
    SLF_TRY(const Quality quality, evaluate_pictures(draw, capture, cameras, evaluation));
    return quality.image.psnr;
  }
  evaluation.deltas_degrees = {settings.observe.delta_degrees};
  evaluation.images = settings.fit.pictures.rounds > 0;
  SLF_TRY(const Quality quality, evaluate(ViewMaps(*decoded), capture, cameras, evaluation));
  return evaluation.images ? quality.image.psnr : quality.points[0].psnr;
}

}  // namespace

std::string missed_bytes(std::size_t target, std::size_t nearest) {
  return "no step gives " + std::to_string(target) + " bytes: the nearest gives " +
         std::to_string(nearest);
}

std::string missed_psnr(double target, double nearest) {
  return "no step gives " + decimals(target) + " dB: the nearest gives " + decimals(nearest);
}

bool has_target(const EncoderSettings& settings) {
  return settings.target_bytes > 0 || settings.target_psnr > 0;
}

Result<Done, InputError> check_target(const EncoderSettings& settings, std::size_t cameras) {
  const auto invalid = [](const char* what) { return InputError{Errc::kInvalidArgument, what}; };
  if (!(settings.target_psnr >= 0 && settings.target_psnr <= 100))
    return invalid("target PSNR: 0 to 100 dB");
  if (settings.target_bitrate > 0) return invalid("target bitrate: of frames in time alone");
  if (settings.target_bytes > 0 && settings.target_psnr > 0)
    return invalid("target: bytes or PSNR, not both");
  if (has_target(settings) && settings.coefficients == CoefficientCoder::kTexture)
    return invalid("target: not for textures, whose quality is their QP");
  if (settings.target_psnr > 0 && cameras == 0)
    return invalid("target PSNR: there are no images to compare with");
  return Done{};
}

Result<Done, InputError> code_to_target(
    const EncoderSettings& settings, const Capture& capture, std::span<const int> cameras,
    const std::function<Result<Done, InputError>(double q)>& code, Encoded& encoded) {
  const bool bytes = settings.target_bytes > 0;
  const double target = bytes ? std::log(settings.target_bytes) : settings.target_psnr;
  const StepGoal goal = bytes ? StepGoal{target + std::log(1 - kByteTolerance), target}
                              : StepGoal{target, target + kPsnrTolerance};
  double last = 0;
  const auto measure = [&](double q) -> Result<double, InputError> {
    last = q;
    SLF_CHECK(code(q));
    if (bytes) return std::log(encoded.stream.size());
    return input_psnr(encoded.stream, capture, cameras, settings);
  };
  SLF_TRY(const StepFound found, find_step(settings.q, goal, measure));
  if (found.q != last) SLF_CHECK(code(found.q));
  if (found.reached) return Done{};
  encoded.warnings.push_back(bytes ? missed_bytes(settings.target_bytes, encoded.stream.size())
                                   : missed_psnr(target, found.value));
  return Done{};
}

}  // namespace slf
