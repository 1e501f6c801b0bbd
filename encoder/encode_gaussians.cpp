// SPDX-License-Identifier: Apache-2.0
#include "slf/encode_gaussians.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/vec3.h"
#include "codec/encoder/pack_frame.h"
#include "encoder/encode_to_target.h"
#include "encoder/gaussian_coding.h"
#include "encoder/gaussian_planes.h"
#include "encoder/rate_control.h"
#include "encoder/splat_pictures.h"
#include "slf/decoder.h"

namespace slf {
namespace {

constexpr double kAboveTarget = 0.05;  // dB of PSNR
constexpr double kNearTarget = 0.5;    // dB: of few splats, PSNR goes up and down with the step

double extent_of(const Gaussians& splats) {
  const auto [low, high] = bounds_of(splats);
  return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
}

class GaussianEncoder {
 public:
  GaussianEncoder(const Gaussians& splats, const EncoderSettings& settings)
      : splats_(splats),
        settings_(settings),
        sizes_{typical_deviation(splats), 0, extent_of(splats)} {
    sizes_.room = room_of(splats, sizes_.deviation);
  }

  Result<double, InputError> code(double q, EncodedGaussians& out) const {
    SLF_TRY(LightField field,
            light_field_of(splats_, grid_step_of(q, sizes_, settings_), settings_.threads));
    for (std::size_t k = 0; k < 3; ++k) field.header.grid.origin[k] += splats_.origin[k];
    SLF_CHECK(check_drawn(field.header.grid));
    field.header.metres_per_unit = settings_.metres_per_unit;
    CodingParameters parameters =
        gaussian_parameters(field.header, steps_of(q),
                            splat_level_ends(field.positions, field.header.grid.bits), settings_);
    parameters.metadata = metadata_of_gaussians(q, settings_);
    out.q = q;
    out.grid = field.header.grid;
    SLF_TRY(out.stream, pack_taken(std::move(field), parameters));
    return std::log(static_cast<double>(out.stream.size()));
  }

 private:
  const Gaussians& splats_;
  const EncoderSettings& settings_;
  SplatSizes sizes_;
};

Result<Done, InputError> code_to_bytes(const GaussianEncoder& encoder, std::uint64_t bytes,
                                       EncodedGaussians& out) {
  const double most = std::log(static_cast<double>(bytes));
  const StepGoal goal{most + std::log(0.99), most};
  const auto measure = [&](double q) { return encoder.code(q, out); };
  SLF_TRY(const StepFound found, find_step(kGaussianQ, goal, measure));
  if (found.q != out.q) SLF_CHECK(encoder.code(found.q, out));
  if (!found.reached) out.warning = missed_bytes(bytes, out.stream.size());
  return Done{};
}

/// With pictures of the splats as they are given, since there are no photographs.
Result<Done, InputError> code_to_psnr(const GaussianEncoder& encoder, const Gaussians& splats,
                                      double psnr, int threads, EncodedGaussians& out) {
  const SplatPictures pictures(splats, threads);
  const auto measure = [&](double q) -> Result<double, InputError> {
    SLF_CHECK(encoder.code(q, out));
    SLF_TRY(const Gaussians shown, decoded_gaussians(out.stream, threads));
    return pictures.psnr_of(shown);
  };
  SLF_TRY(const StepFound found, find_step(kGaussianQ, {psnr, psnr + kAboveTarget}, measure));
  if (found.q != out.q) SLF_CHECK(encoder.code(found.q, out));
  if (!found.reached && !(std::abs(found.value - psnr) <= kNearTarget))
    out.warning = missed_psnr(psnr, found.value);
  return Done{};
}

}  // namespace

Result<Gaussians, InputError> decoded_gaussians(std::span<const std::uint8_t> stream, int threads) {
  DecodeOptions options;
  options.threads = threads;
  options.limits = DecodeLimits::none();
  const auto decoded = decode(stream, options);
  if (!decoded) return InputError{decoded.error().code, "a file of splats does not decode"};
  return gaussians_of(*decoded, threads);
}

Result<EncodedGaussians, InputError> encode_gaussians(Gaussians splats,
                                                      const EncoderSettings& settings,
                                                      const Vec3& origin) {
  SLF_CHECK(check_coding_of_splats(settings));
  SLF_CHECK(check_gaussians(splats));
  if (settings.target_bitrate > 0)
    return InputError{Errc::kInvalidArgument, "target bitrate: of frames in time alone"};
  if (settings.target_psnr > 0 && settings.target_bytes > 0)
    return InputError{Errc::kInvalidArgument, "target: bytes or PSNR, not both"};
  const std::size_t given = splats.size();
  splats.origin = plus(splats.origin, origin);
  const Gaussians shown = that_show(std::move(splats));
  if (shown.size() == 0)
    return InputError{Errc::kInvalidInput, given == 0
                                               ? "has no splats"
                                               : "has no splat with an opacity of 1/255 or more"};
  const GaussianEncoder encoder(shown, settings);
  EncodedGaussians out;
  if (settings.target_bytes > 0) {
    SLF_CHECK(code_to_bytes(encoder, settings.target_bytes, out));
  } else if (settings.target_psnr > 0) {
    SLF_CHECK(code_to_psnr(encoder, shown, settings.target_psnr, settings.threads, out));
  } else {
    SLF_CHECK(encoder.code(settings.q == kAutomaticQ ? kGaussianQ : settings.q, out));
  }
  out.splats = shown.size();
  out.left_out = given - shown.size();
  return out;
}

}  // namespace slf
