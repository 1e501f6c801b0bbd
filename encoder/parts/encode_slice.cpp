// SPDX-License-Identifier: Apache-2.0
#include "encoder/parts/encode_slice.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "attributes/quantiser.h"
#include "base/release.h"
#include "codec/encoder/slice_encoder.h"
#include "codec/encoder/use_transforms.h"
#include "encoder/component_planes.h"
#include "encoder/fit_capture.h"
#include "encoder/parts/scene_cameras.h"
#include "lightfield/octahedral.h"
#include "slf/camera_trust.h"

namespace slf {
namespace {

constexpr float kUnknown = 127.5f;  // of what no photograph and no colour tells

/// View maps of the slice's own points, [own][3 K], in R, G, B.
Result<std::vector<float>, InputError> fit_region(const PlannedScene& scene, const Capture& capture,
                                                  const DepthMaps& depth, const Region& region,
                                                  std::span<const std::size_t> cells,
                                                  const Progress& progress, CodedSlice& report) {
  const ScenePlan& plan = scene.plan;
  const std::size_t functions = static_cast<std::size_t>(plan.fit.basis.num_functions());
  const std::vector<int> cameras = cameras_of(capture, plan.cameras, scene.cells, cells);
  report.cameras = cameras.size();
  const DepthOfCamera depth_of = [&](int camera) { return depth.of(camera); };
  SLF_TRY(SeenPoints seen, observe_points(capture, cameras, world_points(region.cloud), depth_of,
                                          scene.settings.observe, progress));
  Observations world = trusted_observations(std::move(seen.observations), plan.trust);
  report.observations = world.colour.size();
  if (world.colour.empty()) {
    report.unobserved = region.own.size();
    return region.own_rows(unseen_coefficients(region.cloud, functions), 3 * functions);
  }
  CaptureFit fit;
  fit.chosen.settings = scene.settings.fit;
  fit.cameras = plan.trust;
  SLF_CHECK(fit_chosen({capture, cameras, region.cloud, depth_of}, std::move(world), scene.settings,
                       progress, fit));
  report.unobserved = fit.unobserved_points;
  return region.own_rows(fit.coefficients, 3 * functions);
}

/// Values that a transform of the whole scene can hold: what a fit of few views runs away to is
/// limited, not refused.
void limit(std::span<std::int32_t> components, std::uint64_t weight) {
  const auto most =
      static_cast<std::int32_t>(std::floor(static_cast<double>(kCoefficientLimit) /
                                           (std::sqrt(static_cast<double>(weight)) + 2)) -
                                1);
  for (std::int32_t& c : components) c = std::clamp(c, -most, most);
}

std::vector<std::array<std::uint16_t, 2>> own_normals(const Region& region, int bits) {
  std::vector<std::array<std::uint16_t, 2>> normals;
  if (bits == 0) return normals;
  for (const std::uint32_t p : region.own) {
    const auto& n = region.cloud.normals[p];
    normals.push_back(quantise_normal({n[0], n[1], n[2]}, bits));
  }
  return normals;
}

/// A slice without the cells of others.
SceneLayout alone(const SceneLayout& scene, std::size_t slice) {
  const SliceCut& cut = scene.cuts[slice];
  const std::size_t first = cut.first_cell, cells = scene.table.slices[slice].cells();
  SceneLayout layout;
  layout.base_levels = scene.base_levels;
  layout.first_slice = slice;
  layout.cells.assign(scene.cells.begin() + std::ptrdiff_t(first),
                      scene.cells.begin() + std::ptrdiff_t(first + cells));
  for (std::size_t c = 0; c <= cells; ++c)
    layout.weight_before.push_back(scene.weight_before[first + c] - scene.weight_before[first]);
  layout.cuts = {{0, 0, cut.end - cut.begin}};
  return layout;
}

Result<Done, InputError> code(const PlannedScene& scene, const Region& region,
                              std::vector<std::int32_t> components, CodedSlice& coded) {
  const std::vector<std::uint64_t> codes = region.own_codes();
  std::vector<Voxel> positions;
  for (const std::uint32_t p : region.own) positions.push_back(region.cloud.positions[p]);
  const auto normals = own_normals(region, scene.settings.normal_bits);
  const SceneLayout layout = alone(scene.cells.layout, coded.slice);
  coded.sums.resize(layout.cells.size() * scene.coding->planes());
  const UnitLayout units = layout_of(scene.set);
  const SliceToEncode slice{*scene.coding,
                            layout,
                            slots_of(units, Owner::kSlice),
                            coded.slice,
                            {codes, positions, components, normals},
                            nullptr};
  SLF_TRY(coded.units, encode_slice_geometry(slice, nullptr));
  SLF_TRY(SliceTree tree, transform_slice(slice, coded.sums, scene.settings.threads));
  SLF_TRY(const CodedUnits values,
          encode_slice_values(slice, std::move(tree), nullptr, scene.settings.threads));
  coded.units.insert(coded.units.end(), values.begin(), values.end());
  return Done{};
}

}  // namespace

std::vector<float> unseen_coefficients(const VoxelCloud& cloud, std::size_t functions) {
  std::vector<float> coefficients(cloud.positions.size() * functions * 3, 0.0f);
  for (std::size_t p = 0; p < cloud.positions.size(); ++p)
    for (std::size_t c = 0; c < 3; ++c)
      coefficients[3 * functions * p + c] = cloud.colours.empty() ? kUnknown : cloud.colours[p][c];
  return coefficients;
}

Result<CodedSlice, InputError> encode_slice(const PlannedScene& scene, const Capture& capture,
                                            const DepthMaps& depth, std::size_t slice,
                                            const Progress& progress) {
  const ScenePlan& plan = scene.plan;
  const std::vector<std::size_t> cells = scene.cells_of(slice);
  const bool fitted = !plan.cameras.empty();
  SLF_TRY(const Region region,
          read_region(scene.cells, cells, fitted ? voxels_around(scene.cells, plan.spacing) : 0));
  CodedSlice coded;
  coded.slice = slice;
  coded.points = region.own.size();
  coded.around = region.cloud.positions.size() - region.own.size();
  std::vector<float> coefficients;
  if (fitted) {
    SLF_TRY(coefficients, fit_region(scene, capture, depth, region, cells, progress, coded));
  } else {
    coefficients = unseen_coefficients(region.cloud, 1);
  }
  to_coded_channels(coefficients, scene.settings.colour, scene.settings.threads);  // 6.5
  std::vector<std::int32_t> components =
      to_components(coefficients, plan.shift, scene.settings.threads);  // 6.3
  release(coefficients);
  const std::uint32_t weight = scene.cells.layout.weights().of(0, scene.cells.count());
  if (!scene.transforms.empty())  // 7.11
    components = find_components(scene.transforms, scene.coded, std::size_t{3} * plan.shift.size(),
                                 std::move(components), scene.settings.threads);
  limit(components, std::max<std::uint64_t>(weight, coded.points));
  if (progress) progress("code", 0);
  SLF_CHECK(code(scene, region, std::move(components), coded));  // spec 8
  return coded;
}

}  // namespace slf
