// The encoder's main path: photographs and points to bytes. The last step is codec/pack.cpp.
#include <utility>

#include "codec/component_planes.h"
#include "codec/encode_metadata.h"
#include "codec/fit_capture.h"
#include "codec/stopwatch.h"
#include "codec/texture_parameters.h"
#include "slf/encoder.h"

namespace slf {
namespace {

/// A coloured cloud without cameras: the colour is the one component.
Result<CaptureFit, InputError> colours_alone(const VoxelCloud& cloud) {
  if (cloud.colours.empty())
    return InputError{Errc::kInvalidInput,
                      "the capture has no cameras and its points have no colours"};
  CaptureFit fit;
  for (const auto& rgb : cloud.colours)
    fit.coefficients.insert(fit.coefficients.end(), rgb.begin(), rgb.end());
  return fit;
}

/// Cuts of the level-of-detail table: all but the two finest levels, then one each.
std::vector<int> level_ends(int bits) {
  if (bits < 4) return {bits};
  return {bits - 2, bits - 1, bits};
}

CodingParameters coding_parameters(const LightField& field, const EncoderSettings& settings) {
  const LightFieldHeader& header = field.header;
  const bool texture = settings.coefficients == CoefficientCoder::kTexture;
  CodingParameters parameters;
  parameters.geometry = settings.geometry;
  parameters.coefficients = settings.coefficients;
  parameters.texture = settings.texture;
  parameters.step =
      texture ? texture_steps(
                    header.basis, header.shift,
                    least_texture_steps(field, settings.max_slice_points, settings.texture.bits),
                    settings.steps_by_norm)
              : quantiser_steps(header.basis, header.shift, settings.q, settings.steps_by_norm);
  if (settings.preset != Preset::kPaper) {  // the paper codes all in one unit
    parameters.group = scale_groups(header.basis);
    if (!texture) parameters.coefficient_level_ends = level_ends(header.grid.bits);
    if (settings.geometry == GeometryCoder::kOctree)
      parameters.geometry_level_ends = level_ends(header.grid.bits);
  }
  parameters.max_slice_points = settings.max_slice_points;
  parameters.threads = settings.threads;
  return parameters;
}

}  // namespace

Result<Encoded, InputError> encode(const Capture& capture, std::span<const int> cameras,
                                   const EncoderSettings& given, const Progress& progress) {
  EncoderSettings settings = given;
  settings.observe.threads = settings.fit.threads = settings.threads;
  if (cameras.empty()) settings.fit.basis = {BasisId::kBspline, 2, 0, 0};
  SLF_CHECK(check_settings(settings));
  Stopwatch watch;
  Encoded encoded;
  SLF_TRY(const VoxelCloud cloud, voxelise_capture(capture, cameras, settings));  // spec 6.1
  encoded.points = cloud.positions.size();
  encoded.merged = cloud.merged;
  encoded.seconds_voxelise = watch.lap();
  SLF_TRY(CaptureFit fit,  // paper II, III-A
          cameras.empty() ? colours_alone(cloud)
                          : fit_capture(capture, cameras, cloud, settings, progress));
  encoded.observations = fit.observations;
  encoded.unobserved_points = fit.unobserved_points;
  encoded.seconds_observe = fit.seconds_observe;
  encoded.seconds_fit = fit.seconds_fit;
  watch.lap();
  if (progress) progress("code", 0);
  const LightField field = quantise_grid(cloud, std::move(fit), capture.up, settings);  // 6.3, 6.5
  CodingParameters parameters = coding_parameters(field, settings);
  parameters.metadata = encoder_metadata(settings, encoded, cameras.size());
  SLF_TRY(encoded.stream, pack(field, parameters));  // spec 7, 8
  encoded.seconds_code = watch.lap();
  if (progress) progress("code", 1);
  return encoded;
}

}  // namespace slf
