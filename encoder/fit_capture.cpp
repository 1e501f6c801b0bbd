// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit_capture.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/release.h"
#include "base/stopwatch.h"
#include "bitstream/parameter_sets.h"
#include "capture/photograph_size.h"
#include "capture/spacing.h"
#include "encoder/component_planes.h"
#include "encoder/fit/fit_pictures.h"
#include "encoder/refine/refine_geometry.h"
#include "geometry/surface_normals.h"
#include "geometry/weight_classes.h"
#include "lightfield/octahedral.h"

namespace slf {
namespace {

CodedNormals coded_normals(const VoxelCloud& cloud, int bits) {
  CodedNormals normals{bits, {}};
  if (bits > 0)
    for (const auto& n : cloud.normals)
      normals.octahedral.push_back(quantise_normal({n[0], n[1], n[2]}, bits));
  return normals;
}

std::size_t functions_of(const LightFieldHeader& header) {
  return static_cast<std::size_t>(header.num_functions);
}

/// The most that a slice of a scene of so many points may weigh.
std::size_t slice_points_of(std::size_t points) {
  return std::min<std::size_t>(2 * points, kMostBaseWeight);
}

}  // namespace

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

FitSettings in_spacings(FitSettings fit, std::span<const Voxel> positions, int grid_bits) {
  const int spacing_log2 = std::min(cell_of_spacing(positions), grid_bits - 1);
  fit.normal_cell_log2 = spacing_log2;
  fit.hierarchy.block_log2 = std::min(fit.hierarchy.block_log2 + spacing_log2, 21);
  return fit;
}

void fit_colours_alone(EncoderSettings& settings) {
  settings.fit = {};
  settings.fit.basis = {BasisId::kBspline, 2, 0, 0};
  settings.search = FitSearch::none();
}

Result<VoxelCloud, InputError> voxelise_capture(const Capture& capture,
                                                std::span<const int> cameras,
                                                const EncoderSettings& settings) {
  const bool needs_normals =
      !cameras.empty() || settings.normal_bits > 0 || settings.densify.mode == Densify::kOn;
  const auto on_grid = [&](const PointCloud& cloud) {
    return voxelise_geometry(capture, cloud, cameras, settings.grid_bits, settings.voxel_size,
                             settings.densify, settings.threads);
  };
  if (!needs_normals || !capture.cloud.normals.empty()) return on_grid(capture.cloud);
  PointCloud cloud = capture.cloud;
  std::vector<Vec3> viewpoints;
  for (const Camera& camera : capture.cameras) viewpoints.push_back(camera.centre());
  cloud.normals = estimate_normals(cloud, viewpoints, 16, settings.threads);
  return on_grid(cloud);
}

Result<VoxelCloud, InputError> voxelise_mended(const Capture& capture, std::span<const int> cameras,
                                               const EncoderSettings& settings, RefineGeometry mode,
                                               std::function<Result<bool, InputError>()> pays,
                                               RefineReport& report, const Progress& progress) {
  RefineSettings refining{mode,  settings.grid_bits, settings.voxel_size,
                          false, settings.threads,   std::move(pays)};
  Density density;
  if (settings.grid_bits == 0 && settings.voxel_size == 0) {
    density = choose_density(capture, cameras);
    refining.voxel_size = density.voxel_size;
    refining.free_grid = true;
  }
  Stopwatch watch;
  SLF_TRY(const RefinedCloud refined, refine_geometry(capture, cameras, refining, progress));
  report = refined.report;
  report.seconds = watch.lap();
  if (report.outcome != RefineReport::kMended) return voxelise_capture(capture, cameras, settings);
  const double step = refined.voxel_size > 0 ? refined.voxel_size : refining.voxel_size;
  SLF_TRY(VoxelCloud cloud, voxelise(refined.cloud, refining.grid_bits, step));
  cloud.density = density;
  return cloud;
}

Result<Done, InputError> fit_chosen(const FittedCloud& of, Observations world,
                                    const EncoderSettings& settings, const Progress& progress,
                                    CaptureFit& fit) {
  Stopwatch watch;
  const FitSettings& chosen = fit.chosen.settings;
  const VoxelCloud& cloud = of.cloud;
  Observations seen = in_local(std::move(world), chosen.directions, cloud.positions,
                               chosen.normal_cell_log2, settings.threads);
  fit.observations = seen.colour.size();
  for (std::size_t p = 0; p + 1 < seen.first.size(); ++p)
    fit.unobserved_points += seen.first[p] == seen.first[p + 1];
  // Harmonics go on smoothly beyond what was seen; B-splines are held there (spec 6.7).
  if (chosen.basis.id == BasisId::kBspline) {
    fit.gamma_min_q7 = std::clamp(static_cast<int>(std::floor(seen.gamma_min * 127)), -127, 127);
    fit.gamma_max_q7 = std::clamp(static_cast<int>(std::ceil(seen.gamma_max * 127)), -127, 127);
  }
  SLF_TRY(fit.coefficients, fit_view_maps(seen, cloud.positions, chosen, progress));
  fit.seconds_fit = watch.lap();
  if (chosen.pictures.rounds == 0) return Done{};
  seen = of.hold_out
             ? observations_of(seen, held_out_points(cloud.positions, chosen.normal_cell_log2))
             : Observations{};
  trim_heap();
  const CodedNormals normals = coded_normals(cloud, settings.normal_bits);
  const std::array gamma_range = {float(fit.gamma_min_q7) / 127, float(fit.gamma_max_q7) / 127};
  std::vector<int> trusted;
  std::vector<std::array<float, 3>> gains;
  std::vector<int> order(of.cameras.begin(), of.cameras.end());
  std::sort(order.begin(), order.end());
  for (const int camera : order) {
    const auto trust = std::find_if(fit.cameras.begin(), fit.cameras.end(),
                                    [&](const CameraTrust& t) { return t.camera == camera; });
    const bool known = trust != fit.cameras.end();
    if (known && trust->verdict == CameraVerdict::kDropped) continue;
    trusted.push_back(camera);
    if (!fit.cameras.empty()) gains.push_back(known ? trust->gain : CameraTrust{}.gain);
  }
  SLF_TRY(fit.pictures,
          fit_to_pictures(
              {of.capture, trusted, gains, cloud.grid, cloud.positions, normals,
               settings.observe.transfer, gamma_range, of.hidden_by, of.hold_out ? &seen : nullptr},
              chosen, settings.search.pictures, fit.coefficients, progress, &fit.held_out));
  fit.seconds_pictures = watch.lap() - (fit.held_out ? fit.held_out->seconds() : 0);
  return Done{};
}

Result<CaptureFit, InputError> fit_capture(const Capture& given, std::span<const int> cameras,
                                           const VoxelCloud& cloud, const EncoderSettings& settings,
                                           const Progress& progress, bool hold_out) {
  Stopwatch watch;
  CaptureFit fit;
  const ObservedPoints points = world_points(cloud);
  const double spacing = std::max(typical_spacing(points.positions), cloud.grid.step);
  const std::optional<Capture> smaller =
      photographs_for_points(given, cameras, points.positions, spacing);
  const Capture& capture = smaller ? *smaller : given;
  SLF_TRY(Observations world,
          observe(capture, cameras, points, points.positions, spacing, settings.observe, progress));
  if (settings.check_cameras) {
    SLF_TRY(fit.cameras, check_cameras(world, settings.threads));
    world = trusted_observations(std::move(world), fit.cameras);
  }
  fit.seconds_observe = watch.lap();
  SLF_TRY(fit.chosen, choose_fit(world, cloud.positions,
                                 in_spacings(settings.fit, cloud.positions, cloud.grid.bits),
                                 settings.search, progress));
  fit.seconds_choose = watch.lap();
  std::vector<int> used(cameras.begin(), cameras.end());
  if (!fit.cameras.empty()) used = trusted_cameras(fit.cameras);
  SLF_CHECK(
      fit_chosen({capture, used, cloud, {}, hold_out}, std::move(world), settings, progress, fit));
  return fit;
}

Result<CaptureFit, InputError> colours_alone(const VoxelCloud& cloud) {
  if (cloud.colours.empty())
    return InputError{
        Errc::kInvalidInput,
        "the capture has no cameras and its points have no colours (slf pack codes positions "
        "alone, as whole numbers)"};
  CaptureFit fit;
  for (const auto& rgb : cloud.colours)
    fit.coefficients.insert(fit.coefficients.end(), rgb.begin(), rgb.end());
  return fit;
}

namespace {

/// All of quantise_grid but positions, normals, shift and components.
LightFieldHeader header_on_grid(const Grid& grid, const CaptureFit& fit, const Vec3& origin,
                                UpAxis up, const EncoderSettings& settings) {
  LightFieldHeader header;
  header.grid = moved(grid, origin);
  header.basis = settings.fit.basis;
  header.num_functions = header.basis.num_functions();
  header.directions = settings.fit.directions;
  header.colour = settings.colour;
  header.transfer = settings.observe.transfer;
  header.up = up;
  header.metres_per_unit = settings.metres_per_unit;
  header.gamma_min_q7 = fit.gamma_min_q7;
  header.gamma_max_q7 = fit.gamma_max_q7;
  if (header.directions == Directions::kReflected)
    header.normal_cell_log2 = settings.fit.normal_cell_log2;
  return header;
}

}  // namespace

LightField quantise_grid(const VoxelCloud& cloud, CaptureFit fit, const Vec3& origin, UpAxis up,
                         const EncoderSettings& settings, const std::vector<int>& shift) {
  LightField field;
  LightFieldHeader& header = field.header;
  header = header_on_grid(cloud.grid, fit, origin, up, settings);
  to_coded_channels(fit.coefficients, header.colour, settings.threads);
  header.shift = shift;
  if (shift.empty())
    header.shift = component_shifts(fit.coefficients, functions_of(header),
                                    slice_points_of(cloud.positions.size()));
  field.components = to_components(fit.coefficients, header.shift, settings.threads);
  field.positions = cloud.positions;
  field.normals = coded_normals(cloud, settings.normal_bits);
  return field;
}

LightField quantise_rows(const Grid& grid, std::vector<Voxel> positions, FittedRows rows,
                         const CaptureFit& fit, const EncoderSettings& settings,
                         const std::vector<int>& shift) {
  LightField field;
  LightFieldHeader& header = field.header;
  header = header_on_grid(grid, fit, {0, 0, 0}, UpAxis::kUnknown, settings);
  for (auto& piece : rows.pieces()) to_coded_channels(piece, header.colour, settings.threads);
  header.shift = shift;
  if (shift.empty())
    header.shift = component_shifts(rows, functions_of(header), slice_points_of(positions.size()));
  field.components = to_components(std::move(rows), header.shift, settings.threads);
  field.positions = std::move(positions);
  return field;
}

}  // namespace slf
