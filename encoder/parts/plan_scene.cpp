// SPDX-License-Identifier: Apache-2.0
// What the slices of a scene must agree on, chosen once.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/shortest.h"
#include "base/stopwatch.h"
#include "capture/density.h"
#include "capture/spacing.h"
#include "codec/encoder/derive_transforms.h"
#include "codec/encoder/pack_parameters.h"
#include "codec/encoder/use_transforms.h"
#include "codec/sequence.h"
#include "encoder/check_settings.h"
#include "encoder/choose_step.h"
#include "encoder/coding_parameters.h"
#include "encoder/component_planes.h"
#include "encoder/encode_metadata.h"
#include "encoder/fit/environment_fit.h"
#include "encoder/fit_capture.h"
#include "encoder/parts/depth_maps.h"
#include "encoder/parts/encode_slice.h"
#include "encoder/parts/planned_scene.h"
#include "encoder/parts/scene_cameras.h"
#include "encoder/parts/scene_points.h"
#include "encoder/parts/work_directory.h"
#include "geometry/weight_classes.h"

namespace slf {
namespace {

constexpr std::size_t kSpacingRun = 30000;  // points in Morton order that the spacing is taken from
/// Components of the scene may be so much larger than those of the sample.
constexpr float kMargin = 2;

/// Cells spread over the scene, of about kPlanSample points.
std::vector<std::size_t> sample_cells(const SceneCells& cells) {
  const auto points = static_cast<double>(cells.store.size());
  const auto every = static_cast<std::size_t>(
      std::max(1.0, std::floor(points / static_cast<double>(kPlanSample))));
  std::vector<std::size_t> sample;
  for (std::size_t c = every / 2; c < cells.count(); c += every) sample.push_back(c);
  return sample;
}

/// A scene on its way to a plan.
class Planner {
 public:
  Planner(const Capture& capture, const EncoderSettings& settings, const SceneWork& work,
          const Progress& progress, ScenePlan& plan)
      : capture_(capture), settings_(settings), work_(work), progress_(progress), plan_(plan) {}

  Result<Done, InputError> plan_points() {
    GridWanted wanted{settings_.grid_bits, settings_.voxel_size};
    if (wanted.bits == 0 && wanted.voxel_size == 0) {  // what the photographs resolve
      density_ = choose_density(capture_, plan_.cameras);
      wanted.voxel_size = density_.voxel_size;
      if (!capture_.mesh.triangles.empty() && density_.pixel > 0)  // as many points as it takes
        density_.voxel_size = wanted.voxel_size = kPixelsPerVoxel * density_.pixel;
      if (wanted.voxel_size == 0) wanted.bits = 1;
    }
    SLF_TRY(const ScenePoints points,
            store_points(capture_, plan_.cameras, settings_, wanted, work_.directory));
    encoded_.merged = points.merged;
    plan_.grid = points.grid;
    plan_.points_digest = points.stored.digest;
    SLF_TRY(cells_, SceneCells::open(work_.directory, plan_.points_digest, points.stored.points,
                                     plan_.grid));
    SLF_TRY(const auto codes, cells_.store.codes(0, points.stored.points));
    plan_.spacing = spacing_of(codes);
    SLF_CHECK(lay_out_scene(codes, plan_.spacing, settings_, cells_));
    plan_.base_levels = cells_.layout.base_levels;
    for (const SliceEntry& slice : cells_.layout.table.slices)
      plan_.slices.push_back(
          {static_cast<std::uint32_t>(slice.cells()), static_cast<std::uint32_t>(slice.points())});
    return Done{};
  }

  Result<Done, InputError> plan_fit() {
    sample_ = sample_cells(cells_);
    const int around = plan_.cameras.empty() ? 0 : voxels_around(cells_, plan_.spacing);
    SLF_TRY(region_, read_region(cells_, sample_, around));
    if (plan_.cameras.empty()) {
      plan_.fit = settings_.fit;
      coefficients_ = unseen_coefficients(region_.cloud, 1);
      return Done{};
    }
    plan_.reduction = choose_reduction(capture_, plan_.cameras, cells_, plan_.spacing);
    SLF_CHECK(fit_sample(scene_cameras(capture_, plan_, cache_of(plan_, work_))));
    const PictureFitSettings& pictures = plan_.fit.pictures;
    if (pictures.rounds > 0 && fit_.pictures.pull == 0) plan_.fit.pictures.rounds = 0;
    if (pictures.rounds > 0) {  // what was found once holds for every slice
      plan_.fit.pictures.mean_penalty *= fit_.pictures.pull;
      plan_.fit.pictures.penalty *= fit_.pictures.pull;
    }
    return Done{};
  }

  Result<Done, InputError> plan_coding() {
    coefficients_ = region_.own_rows(
        coefficients_,
        coefficients_.size() / std::max<std::size_t>(region_.cloud.positions.size(), 1));
    to_coded_channels(coefficients_, settings_.colour, settings_.threads);
    const auto functions = static_cast<std::size_t>(plan_.fit.basis.num_functions());
    std::vector<float> larger = coefficients_;
    for (float& c : larger) c *= kMargin;
    plan_.shift = component_shifts(larger, functions,
                                   std::min<std::size_t>(2 * cells_.store.size(), kMostBaseWeight));
    EncoderSettings settings = settings_;
    settings.fit = plan_.fit;
    SLF_CHECK(plan_step(settings));
    encoded_.q = settings.q;
    encoded_.grid = moved(plan_.grid, plan_.origin);
    encoded_.density = density_;
    encoded_.fit = fit_.chosen;
    encoded_.fit.settings = plan_.fit;
    encoded_.cameras = plan_.trust;
    settings.metadata = plan_.metadata;
    plan_.metadata = encoder_metadata(settings, encoded_, plan_.cameras.size());
    for (const CameraTrust& t : plan_.trust)
      if (t.verdict == CameraVerdict::kDropped) std::erase(plan_.cameras, t.camera);
    return plan_transforms(settings);
  }

 private:
  /// The median of three places: what is typical needs no tree of all points.
  double spacing_of(std::span<const std::uint64_t> codes) const {
    std::array<double, 3> spacing{};
    for (std::size_t i = 0; i < spacing.size(); ++i) {
      const std::size_t count = std::min(codes.size(), kSpacingRun),
                        begin = (codes.size() - count) / 2 * i;
      spacing[i] = typical_spacing(positions_of(cells_, codes.subspan(begin, count)));
    }
    std::sort(spacing.begin(), spacing.end());
    return std::max(spacing[1], plan_.grid.step);
  }

  /// Cameras, settings, light and coefficients of the sample.
  Result<Done, InputError> fit_sample(const Capture& capture) {
    const VoxelCloud& cloud = region_.cloud;
    SLF_TRY(const DepthMaps maps,
            DepthMaps::in(work_.directory, capture, cells_, plan_, settings_));
    const DepthOfCamera depth_of = [&](int camera) { return maps.of(camera); };
    const std::vector<int> cameras = cameras_of(capture, plan_.cameras, cells_, sample_);
    Stopwatch watch;
    SLF_TRY(SeenPoints seen, observe_points(capture, cameras, world_points(cloud), depth_of,
                                            settings_.observe, progress_));
    const double observing =
        watch.lap() / static_cast<double>(std::max<std::size_t>(cameras.size(), 1));
    Observations world = std::move(seen.observations);
    if (world.colour.empty())
      return InputError{Errc::kInvalidInput, "no camera sees any point of a sample of the scene"};
    if (settings_.check_cameras) {
      SLF_TRY(fit_.cameras, check_cameras(world, settings_.threads));
      world = trusted_observations(std::move(world), fit_.cameras);
    }
    plan_.trust = fit_.cameras;
    encoded_.observations = world.colour.size();
    SLF_TRY(fit_.chosen, choose_fit(world, cloud.positions,
                                    in_spacings(settings_.fit, cloud.positions, cloud.grid.bits),
                                    settings_.search, progress_));
    FitSettings& chosen = fit_.chosen.settings;
    const Observations local = in_local(world, chosen.directions, cloud.positions,
                                        chosen.normal_cell_log2, settings_.threads);
    chosen.environment.known = known_light(local, cloud.positions, chosen);
    if (chosen.environment.known.half == 0) chosen.environment.degree = 0;
    watch.lap();
    SLF_CHECK(fit_chosen(
        {capture, cameras, cloud, depth_of, chooses_step(settings_, plan_.cameras.size())},
        std::move(world), settings_, progress_, fit_));
    plan_.seconds = seconds_of_slices(observing, watch.lap(), capture);
    plan_.fit = chosen;
    plan_.gamma_min_q7 = fit_.gamma_min_q7;
    plan_.gamma_max_q7 = fit_.gamma_max_q7;
    coefficients_ = std::move(fit_.coefficients);
    return Done{};
  }

  /// @param observing  seconds for a camera of the sample
  /// @param fitting    seconds for the sample
  double seconds_of_slices(double observing, double fitting, const Capture& capture) const {
    double seconds = 0;
    std::size_t cell = 0;
    for (const SliceEntry& slice : cells_.layout.table.slices) {
      std::vector<std::size_t> cells(slice.cells());
      std::iota(cells.begin(), cells.end(), cell);
      cell += slice.cells();
      const double samples = kWithAround * static_cast<double>(slice.points()) /
                             static_cast<double>(region_.cloud.positions.size());
      const std::size_t cameras = cameras_of(capture, plan_.cameras, cells_, cells).size();
      seconds += samples * (fitting + observing * static_cast<double>(cameras));
    }
    return seconds;
  }

  /// One step for all slices, by the sample: into the settings of the plan, as if it were given.
  Result<Done, InputError> plan_step(EncoderSettings& settings) {
    if (settings.q != kAutomaticQ) return Done{};
    SLF_TRY(const StepAndOrigin step,
            choose_step(settings, fit_, plan_.grid, cells_.store.size(), plan_.cameras.size()));
    fit_.held_out.reset();
    settings.q = step.q;
    encoded_.step = plan_.step = step.chosen;
    std::erase_if(plan_.settings, [](const auto& given) {
      return given.first == "quality" || given.first == "quality-loss";
    });
    plan_.settings.emplace_back("quality", shortest(step.q));
    return Done{};
  }

  Result<Done, InputError> plan_transforms(const EncoderSettings& settings) {
    LightField field = scene_header(plan_, settings);
    CodingParameters parameters = coding_parameters(field, settings);
    parameters.metadata = plan_.metadata;
    SLF_TRY(const SequenceParameterSet set, sequence_of(field, parameters));
    if (settings.transform == TransformMode::kNone) return Done{};
    const auto components = to_components(coefficients_, plan_.shift, settings.threads);
    const std::vector<std::uint64_t> codes = region_.own_codes();
    const std::vector<SliceCut> cuts = {{0, 0, codes.size()}};
    const double scale = static_cast<double>(cells_.store.size()) /
                         static_cast<double>(std::max<std::size_t>(codes.size(), 1));
    for (const ForwardTransform& t : derive_transforms(
             {codes, components, cuts, scale}, plane_groups(set), 0, error_weights(field.header),
             plane_steps(set), settings.transform, settings.threads)) {
      plan_.transforms.push_back({t.inverse, t.precision});
      plan_.transforms.back().coded.components.clear();
    }
    return Done{};
  }

  const Capture& capture_;
  const EncoderSettings& settings_;
  const SceneWork& work_;
  const Progress& progress_;
  ScenePlan& plan_;
  SceneCells cells_;
  Density density_;
  Encoded encoded_;
  std::vector<std::size_t> sample_;
  Region region_;
  CaptureFit fit_;
  std::vector<float> coefficients_;  // [points of the region][3 K], later of own ones
};

}  // namespace

Result<ScenePlan, InputError> plan_scene(const Capture& capture, std::span<const int> cameras,
                                         const GivenSettings& given, const Metadata& metadata,
                                         const SceneWork& work, const Progress& progress) {
  SLF_TRY(const EncoderSettings settings,
          scene_settings(given, !capture.cameras.empty(), work.threads));
  SLF_CHECK(check_settings(settings));
  SLF_CHECK(check_capture(capture, cameras));
  if (cameras.empty() && !capture.cameras.empty())
    return InputError{Errc::kInvalidArgument, "none of the capture's cameras is to be used"};
  SLF_CHECK(make_directory(work.directory));
  ScenePlan plan;
  plan.settings = given;
  plan.metadata = metadata;
  plan.cameras.assign(cameras.begin(), cameras.end());
  std::sort(plan.cameras.begin(), plan.cameras.end());
  plan.capture_cameras = capture.cameras.size();
  plan.photographs_digest = digest_of_photographs(capture, capture.origin);
  plan.origin = capture.origin;
  plan.up = capture.up;
  if (cameras.empty() && capture.cloud.colours.empty())
    return InputError{
        Errc::kInvalidInput,
        "the capture has no cameras and its points have no colours (slf pack codes positions "
        "alone, as whole numbers)"};
  plan.planning_bytes = memory_of_points(capture, cameras, settings);
  SLF_CHECK(check_planning(plan, work));
  Planner planner(capture, settings, work, progress, plan);
  SLF_CHECK(planner.plan_points());
  plan.fit = settings.fit;
  SLF_CHECK(check_memory(plan, work));
  SLF_CHECK(planner.plan_fit());
  SLF_CHECK(planner.plan_coding());
  return plan;
}

}  // namespace slf
