// SPDX-License-Identifier: Apache-2.0
#include "encoder/parts/planned_scene.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/hexadecimal.h"
#include "base/sha256.h"
#include "codec/encoder/forward_columns.h"
#include "codec/encoder/pack_parameters.h"
#include "codec/encoder/use_transforms.h"
#include "codec/sequence.h"
#include "codec/transform_units.h"
#include "encoder/coding_parameters.h"
#include "encoder/fit/fit_settings.h"
#include "encoder/fit_capture.h"
#include "encoder/parts/work_directory.h"

namespace slf {
namespace {

constexpr std::size_t kPointsOfCell = 512;  // at least: what the base has is apart from slices

InputError refused(const std::string& what) {
  return {Errc::kInvalidArgument, std::string(what) + " needs the whole scene at once"};
}

InputError wrong_plan(const std::string& cause) { return {Errc::kInvalidInput, "plan: " + cause}; }

/// Nodes of a level, of codes in ascending order.
std::size_t nodes_at(std::span<const std::uint64_t> codes, int below) {
  std::size_t nodes = codes.empty() ? 0 : 1;
  for (std::size_t p = 1; p < codes.size(); ++p)
    nodes += codes[p] >> (3 * below) != codes[p - 1] >> (3 * below);
  return nodes;
}

CodingParameters scene_parameters(const LightField& field, const ScenePlan& plan,
                                  const EncoderSettings& settings) {
  CodingParameters parameters = coding_parameters(field, settings);
  parameters.slice_start = SliceStart::kApart;
  parameters.metadata = plan.metadata;
  return parameters;
}

/// A plan may come from anywhere: of what was read as numbers, whether they go together.
Result<ForwardTransform, InputError> transform_of(const PlannedTransform& planned,
                                                  const PlaneGroups& groups, std::size_t free_group,
                                                  const std::vector<double>& weights) {
  PlaneTransform coded = planned.coded;
  if (coded.first_group < free_group || coded.num_groups < 1 ||
      coded.first_group + coded.num_groups > groups.size())
    return wrong_plan("transforms: groups that there are not, or twice");
  coded.functions = functions_of_groups(groups, coded.first_group, coded.num_groups);
  if (coded.rank > coded.functions.size())
    return wrong_plan("transforms: a rank above the functions of its groups");
  if (coded.matrix.size() != coded.rows() * coded.columns() ||
      planned.precision.size() != coded.columns())
    return wrong_plan("transforms: a matrix of another size");
  ForwardTransform forward = forward_transform(std::move(coded), planned.precision, weights);
  const auto finite = [](double x) { return std::isfinite(x); };
  bool invertible = std::all_of(forward.matrix.begin(), forward.matrix.end(), finite);
  for (const auto& row : forward.colour)
    invertible = invertible && std::all_of(row.begin(), row.end(), finite);
  if (!invertible) return wrong_plan("transforms: colours that cannot be told apart");
  return forward;
}

Result<Done, InputError> set_up_coding(PlannedScene& scene) {
  const LightField field = scene_header(scene.plan, scene.settings);
  const CodingParameters parameters = scene_parameters(field, scene.plan, scene.settings);
  const SceneLayout& layout = scene.cells.layout;
  SLF_TRY(scene.set, sequence_of(field, parameters));
  set_base(layout, scene.set);
  scene.coding.reset(new SliceCoding{scene.set, plane_groups(scene.set), plane_steps(scene.set),
                                     parameters.digest, parameters.texture, parameters.rdo});
  scene.coded.resize(static_cast<std::size_t>(field.header.num_functions));
  std::iota(scene.coded.begin(), scene.coded.end(), std::uint16_t{0});
  const std::vector<double> weights = error_weights(field.header);
  std::size_t free_group = 0;
  for (const PlannedTransform& planned : scene.plan.transforms) {
    SLF_TRY(auto transform, transform_of(planned, scene.coding->groups, free_group, weights));
    free_group = planned.coded.first_group + planned.coded.num_groups;
    scene.transforms.push_back(std::move(transform));
  }
  if (!scene.transforms.empty()) {
    SLF_TRY(scene.coded, use_transforms(field, layout, parameters, scene.transforms, scene.set,
                                        *scene.coding, scene.head));
  }
  SLF_TRY(auto table, write_slice_table(layout.table, scene.set));
  scene.head.push_back({UnitType::kSlices, std::move(table), {}});
  return Done{};
}

bool same_slices(const ScenePlan& plan, const SceneLayout& layout) {
  const auto& entries = layout.table.slices;
  return layout.base_levels == plan.base_levels &&
         std::equal(entries.begin(), entries.end(), plan.slices.begin(), plan.slices.end(),
                    [](const SliceEntry& a, const PlannedSlice& b) {
                      return a.cells() == b.cells && a.points() == b.points;
                    });
}

}  // namespace

std::uint64_t ScenePlan::points() const {
  return std::accumulate(slices.begin(), slices.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const PlannedSlice& s) { return sum + s.points; });
}

std::vector<std::size_t> PlannedScene::cells_of(std::size_t slice) const {
  std::size_t first = 0;
  for (std::size_t s = 0; s < slice; ++s) first += plan.slices[s].cells;
  std::vector<std::size_t> of_slice(plan.slices[slice].cells);
  std::iota(of_slice.begin(), of_slice.end(), first);
  return of_slice;
}

Result<EncoderSettings, InputError> scene_settings(const GivenSettings& given, bool cameras,
                                                   int threads) {
  SLF_TRY(EncoderSettings settings, settings_from(given));
  if (settings.target_bytes > 0 || settings.target_psnr > 0 || settings.target_bitrate > 0)
    return refused("a target");
  if (settings.geometry == GeometryCoder::kDraco) return refused("--geometry draco");
  if (settings.coefficients == CoefficientCoder::kTexture) return refused("--coefficients texture");
  for (const Surface surface : {Surface::kMended, Surface::kTrained, Surface::kSplats})
    if (settings.surface == surface) return refused(std::string("--surface ") + word_of(surface));
  if (settings.splats > 0) return refused("--splats");
  if (settings.match_exposure == MatchExposure::kOn) return refused("--match-exposure on");
  if (settings.refine_cameras == RefineCameras::kOn) return refused("--refine-cameras on");
  if (settings.densify.mode == Densify::kOn) return refused("--densify on");
  if (settings.preset == Preset::kPaper) return refused("--preset paper");
  if (settings.fit.method != FitMethod::kHierarchical) return refused("--fit paper");
  if (settings.base_levels == 0) return refused("--base-levels 0");
  const auto is_given = [&](const char* name) {
    return std::any_of(given.begin(), given.end(), [&](const auto& s) { return s.first == name; });
  };
  if (is_given("slice-start") && settings.slice_start != SliceStart::kApart)
    return refused("a --slice-start but apart");
  if (is_given("photograph-pixels")) return refused("--photograph-pixels");  // a spacing decides
  settings.photograph_pixels = 0;
  if (!is_given("slice-points")) settings.max_slice_points = kScenePoints;
  settings.surface = Surface::kGiven;
  settings.densify.mode = Densify::kOff;
  if (!cameras) fit_colours_alone(settings);
  settings.threads = settings.fit.threads = settings.observe.threads = threads;
  return settings;
}

Result<Done, InputError> lay_out_scene(std::span<const std::uint64_t> codes, double spacing,
                                       const EncoderSettings& settings, SceneCells& cells) {
  const Grid& grid = cells.grid;
  CodingParameters parameters;
  parameters.slice_start = SliceStart::kApart;
  // Two at least: one alone would start from the base.
  parameters.max_slice_points = std::clamp<std::uint32_t>(
      static_cast<std::uint32_t>(std::min<std::size_t>((codes.size() + 1) / 2, kMostSlicePoints)),
      1, settings.max_slice_points);
  parameters.base_levels = settings.base_levels;
  if (settings.base_levels == kAutomaticBase) {
    const double around = kAround * std::max(spacing, grid.step) / grid.step;
    int level = 1;
    while (level + 2 < grid.bits && std::ldexp(1, grid.bits - level - 1) >= around &&
           nodes_at(codes, grid.bits - level - 1) * kPointsOfCell <= codes.size())
      ++level;
    parameters.base_levels = level;
  }
  const InputError too_small{Errc::kInvalidInput, "the scene is too small to be coded in parts"};
  if (grid.bits < 2) return too_small;
  SLF_TRY(cells.layout, lay_out(codes, grid.bits, parameters));
  if (cells.layout.cuts.size() < 2) return too_small;
  const int below = 3 * cells.cell_bits();
  cells.first.clear();
  for (std::size_t p = 0; p < codes.size(); ++p)
    if (p == 0 || codes[p] >> below != codes[p - 1] >> below) cells.first.push_back(p);
  cells.first.push_back(codes.size());
  return Done{};
}

int voxels_around(const SceneCells& scene, double spacing) {
  const double wanted = std::ceil(kAround * spacing / scene.grid.step);
  return static_cast<int>(std::min(wanted, std::ldexp(1, scene.cell_bits())));
}

LightField scene_header(const ScenePlan& plan, const EncoderSettings& settings) {
  LightField field;
  LightFieldHeader& header = field.header;
  header.grid = moved(plan.grid, plan.origin);
  header.basis = plan.fit.basis;
  header.num_functions = header.basis.num_functions();
  header.directions = plan.fit.directions;
  header.colour = settings.colour;
  header.transfer = settings.observe.transfer;
  header.up = plan.up;
  header.metres_per_unit = settings.metres_per_unit;
  header.gamma_min_q7 = plan.gamma_min_q7;
  header.gamma_max_q7 = plan.gamma_max_q7;
  if (header.directions == Directions::kReflected)
    header.normal_cell_log2 = plan.fit.normal_cell_log2;
  header.shift = plan.shift;
  field.positions = {{0, 0, 0}};
  field.components.resize(std::size_t{3} * static_cast<std::size_t>(header.num_functions));
  field.normals = {settings.normal_bits, {}};
  if (settings.normal_bits > 0) field.normals.octahedral.resize(1);
  return field;
}

std::array<std::uint8_t, 32> digest_of(const ScenePlan& plan) {
  const std::string text = write_plan(plan);
  Sha256 sha;
  sha.update({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return sha.finish();
}

Result<std::unique_ptr<PlannedScene>, InputError> open_scene(const ScenePlan& plan,
                                                             const SceneWork& work) {
  auto scene = std::make_unique<PlannedScene>(plan);
  SLF_TRY(scene->settings, scene_settings(plan.settings, !plan.cameras.empty(), work.threads));
  if (scene->settings.q == kAutomaticQ)
    return wrong_plan("settings: quality: not a number, of which all slices need one");
  FitSettings& fit = scene->settings.fit;
  fit = plan.fit;
  fit.threads = work.threads;
  if (const auto sound = check_fit_settings(fit); !sound)
    return wrong_plan("fit: " + sound.error().message);
  scene->settings.search = FitSearch::none();
  scene->directory = work.directory / hexadecimal(digest_of(plan)).substr(0, 16);
  SLF_CHECK(make_directory(scene->directory));
  SceneCells& cells = scene->cells;
  SLF_TRY(cells, SceneCells::open(work.directory, plan.points_digest, plan.points(), plan.grid));
  SLF_TRY(const auto codes, cells.store.codes(0, cells.store.size()));
  SLF_CHECK(lay_out_scene(codes, plan.spacing, scene->settings, cells));
  if (!same_slices(plan, cells.layout)) return wrong_plan("slices: not those of its points");
  SLF_CHECK(set_up_coding(*scene));
  return scene;
}

}  // namespace slf
