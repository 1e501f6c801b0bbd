// The encoder's main path: photographs and points to bytes. The last step is codec/pack.cpp.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "capture/spacing.h"
#include "codec/component_planes.h"
#include "codec/encode_metadata.h"
#include "lightfield/octahedral.h"
#include "slf/encoder.h"

namespace slf {
namespace {

class Stopwatch {
 public:
  /// Seconds since the last lap, or since construction.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

InputError invalid(std::string what) { return {Errc::kInvalidArgument, std::move(what)}; }

Result<Done, InputError> check_settings(const EncoderSettings& s) {
  const Basis& b = s.fit.basis;
  if (!(s.q >= 0.05 && s.q <= 4096)) return invalid("q: 0.05 to 4096");
  if (s.voxel_size < 0 || !std::isfinite(s.voxel_size)) return invalid("voxel size: above 0");
  if (s.voxel_size == 0 && (s.grid_bits < 1 || s.grid_bits > 21))
    return invalid("grid bits: 1 to 21");
  if (b.order < 1 || b.order > 4) return invalid("order: 1 to 4");
  if (b.scales_theta < 0 || b.scales_theta > 6 || b.scales_gamma < 0 || b.scales_gamma > 6)
    return invalid("scales: 0 to 6");
  if (!(s.observe.delta_degrees >= 0 && s.observe.delta_degrees <= 90))
    return invalid("delta: 0 to 90 degrees");
  if (!(s.fit.lambda >= 0) || !std::isfinite(s.fit.lambda)) return invalid("lambda: 0 or more");
  if (!(s.fit.beta >= 0) || !std::isfinite(s.fit.beta)) return invalid("beta: 0 or more");
  if (s.fit.iterations < 0 || s.fit.iterations > 100) return invalid("iterations: 0 to 100");
  if (s.fit.neighbours < 1 || s.fit.neighbours > 64) return invalid("neighbours: 1 to 64");
  if (s.normal_bits != 0 && (s.normal_bits < 4 || s.normal_bits > 12))
    return invalid("normal bits: 0, or 4 to 12");
  return Done{};
}

/// The cloud on the grid, with normals: those of the capture or estimated ones.
Result<VoxelCloud, InputError> voxelise_capture(const Capture& capture,
                                                std::span<const int> cameras,
                                                const EncoderSettings& settings) {
  const bool needs_normals = !cameras.empty() || settings.normal_bits > 0;
  if (!needs_normals || !capture.cloud.normals.empty())
    return voxelise(capture.cloud, settings.grid_bits, settings.voxel_size);
  PointCloud cloud = capture.cloud;
  std::vector<Vec3> viewpoints;
  for (const Camera& camera : capture.cameras) viewpoints.push_back(camera.centre());
  cloud.normals = estimate_normals(cloud, viewpoints, 16, settings.threads);
  return voxelise(cloud, settings.grid_bits, settings.voxel_size);
}

ObservedPoints world_points(const VoxelCloud& cloud) {
  ObservedPoints points;
  for (const Voxel& v : cloud.positions) {
    const Vec3 w = cloud.grid.world(v);
    points.positions.push_back(
        {static_cast<float>(w[0]), static_cast<float>(w[1]), static_cast<float>(w[2])});
  }
  points.normals = cloud.normals;
  return points;
}

/// View maps from what the cameras saw, [P][K][3] in R, G, B.
Result<std::vector<float>, InputError> fit_capture(const Capture& capture,
                                                   std::span<const int> cameras,
                                                   const VoxelCloud& cloud,
                                                   const EncoderSettings& settings,
                                                   const Progress& progress,
                                                   LightFieldHeader& header, Encoded& encoded) {
  Stopwatch watch;
  const ObservedPoints points = world_points(cloud);
  const double spacing = std::max(typical_spacing(points.positions), cloud.grid.step);
  SLF_TRY(const Observations seen,
          observe(capture, cameras, points, points.positions, spacing, settings.observe, progress));
  encoded.observations = seen.colour.size();
  for (std::size_t p = 0; p + 1 < seen.first.size(); ++p)
    encoded.unobserved_points += seen.first[p] == seen.first[p + 1];
  header.gamma_min_q7 = std::clamp(static_cast<int>(std::floor(seen.gamma_min * 127)), -127, 127);
  header.gamma_max_q7 = std::clamp(static_cast<int>(std::ceil(seen.gamma_max * 127)), -127, 127);
  encoded.seconds_observe = watch.lap();
  auto coefficients = fit_view_maps(seen, cloud.positions, settings.fit, progress);
  encoded.seconds_fit = watch.lap();
  return coefficients;
}

/// A coloured cloud without cameras: the colour is the one component.
Result<std::vector<float>, InputError> colours_alone(const VoxelCloud& cloud) {
  if (cloud.colours.empty())
    return InputError{Errc::kInvalidInput,
                      "the capture has no cameras and its points have no colours"};
  std::vector<float> coefficients;
  for (const auto& rgb : cloud.colours)
    coefficients.insert(coefficients.end(), rgb.begin(), rgb.end());
  return coefficients;
}

CodedNormals coded_normals(const VoxelCloud& cloud, int bits) {
  CodedNormals normals{bits, {}};
  if (bits > 0)
    for (const auto& n : cloud.normals)
      normals.octahedral.push_back(quantise_normal({n[0], n[1], n[2]}, bits));
  return normals;
}

/// Cuts of the level-of-detail table: all but the two finest levels, then one each.
std::vector<int> level_ends(int bits) {
  if (bits < 4) return {bits};
  return {bits - 2, bits - 1, bits};
}

CodingParameters coding_parameters(const LightFieldHeader& header,
                                   const EncoderSettings& settings) {
  CodingParameters parameters;
  parameters.geometry = settings.geometry;
  parameters.coefficients = settings.coefficients;
  parameters.step = quantiser_steps(header.basis, header.shift, settings.q, settings.steps_by_norm);
  if (settings.preset != Preset::kPaper) {  // the paper codes all in one unit
    parameters.group = scale_groups(header.basis);
    parameters.coefficient_level_ends = level_ends(header.grid.bits);
    if (settings.geometry == GeometryCoder::kOctree)
      parameters.geometry_level_ends = level_ends(header.grid.bits);
  }
  parameters.max_slice_points = settings.max_slice_points;
  parameters.threads = settings.threads;
  return parameters;
}

/// The integer light field; the coefficients are used up.
LightField quantise_grid(const Capture& capture, const VoxelCloud& cloud,
                         std::vector<float> coefficients, const EncoderSettings& settings,
                         LightFieldHeader header) {
  header.grid = cloud.grid;
  header.basis = settings.fit.basis;
  header.num_functions = header.basis.num_functions();
  header.colour = settings.colour;
  header.transfer = settings.observe.transfer;
  header.up = capture.up;
  to_coded_channels(coefficients, header.colour, settings.threads);
  header.shift =
      component_shifts(coefficients, static_cast<std::size_t>(header.num_functions),
                       std::min<std::size_t>(cloud.positions.size(), settings.max_slice_points));
  LightField field;
  field.components = to_components(coefficients, header.shift, settings.threads);
  field.positions = cloud.positions;
  field.normals = coded_normals(cloud, settings.normal_bits);
  field.header = std::move(header);
  return field;
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
  LightFieldHeader header;
  SLF_TRY(const VoxelCloud cloud, voxelise_capture(capture, cameras, settings));  // spec 6.1
  encoded.points = cloud.positions.size();
  encoded.merged = cloud.merged;
  encoded.seconds_voxelise = watch.lap();
  SLF_TRY(auto coefficients,  // paper II, III-A
          cameras.empty()
              ? colours_alone(cloud)
              : fit_capture(capture, cameras, cloud, settings, progress, header, encoded));
  watch.lap();
  if (progress) progress("code", 0);
  const LightField field =  // spec 6.3, 6.5
      quantise_grid(capture, cloud, std::move(coefficients), settings, std::move(header));
  CodingParameters parameters = coding_parameters(field.header, settings);
  parameters.metadata = encoder_metadata(settings, encoded, cameras.size());
  SLF_TRY(encoded.stream, pack(field, parameters));  // spec 7, 8
  encoded.seconds_code = watch.lap();
  if (progress) progress("code", 1);
  return encoded;
}

}  // namespace slf
