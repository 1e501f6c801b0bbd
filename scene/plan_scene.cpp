// What the slices of a scene must agree on, chosen once.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "capture/density.h"
#include "capture/spacing.h"
#include "codec/derive_transforms.h"
#include "codec/pack_parameters.h"
#include "codec/sequence.h"
#include "codec/use_transforms.h"
#include "encoder/coding_parameters.h"
#include "encoder/component_planes.h"
#include "encoder/encode_metadata.h"
#include "encoder/fit_capture.h"
#include "fit/environment_fit.h"
#include "geometry/morton.h"
#include "geometry/weight_classes.h"
#include "scene/depth_maps.h"
#include "scene/planned_scene.h"

namespace slf {
namespace {

constexpr std::size_t kSample = kPlanSample;  // points that everything is chosen on, about
constexpr std::size_t kSpacingRun = 30000;  // points in Morton order that the spacing is taken from
/// Components of the scene may be so much larger than those of the sample.
constexpr float kMargin = 2;

/// The grid: as given, or what the photographs resolve, however many points that makes.
Result<VoxelCloud, InputError> voxelise_scene(const Capture& capture, std::span<const int> cameras,
                                              EncoderSettings settings, Density& density) {
  if (settings.grid_bits == 0 && settings.voxel_size == 0) {
    density = choose_density(capture, cameras);
    settings.voxel_size = density.voxel_size;
    if (settings.voxel_size == 0) settings.grid_bits = 1;
  }
  return voxelise_capture(capture, cameras, settings);
}

/// Cells spread over the scene, of about kSample points.
std::vector<std::size_t> sample_cells(const SceneCells& cells) {
  const auto points = static_cast<double>(cells.store.size());
  const auto every =
      static_cast<std::size_t>(std::max(1.0, std::floor(points / static_cast<double>(kSample))));
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
    SLF_TRY(VoxelCloud cloud, voxelise_scene(capture_, plan_.cameras, settings_, density_));
    encoded_.merged = cloud.merged;
    plan_.grid = cloud.grid;
    SLF_TRY(plan_.points_digest, PointStore::write(work_.directory, cloud));
    const std::uint64_t points = cloud.positions.size();
    cloud = {};
    SLF_TRY(cells_.store, PointStore::open(work_.directory, plan_.points_digest, points));
    cells_.grid = plan_.grid;
    SLF_TRY(const auto codes, cells_.store.codes(0, points));
    plan_.spacing = spacing_of(codes);
    SLF_TRY(cells_.layout, lay_out_scene(codes, plan_.grid, plan_.spacing, settings_));
    cells_.first = first_points(cells_.layout, codes, plan_.grid.bits);
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
      coefficients_ = colours();
      return Done{};
    }
    SLF_CHECK(fit_sample());
    const PictureFitSettings& pictures = plan_.fit.pictures;
    if (pictures.rounds > 0 && fit_.pictures.pull == 0) plan_.fit.pictures.rounds = 0;
    if (pictures.rounds > 0) {  // what was found once holds for every slice
      plan_.fit.pictures.mean_penalty *= fit_.pictures.pull;
      plan_.fit.pictures.penalty *= fit_.pictures.pull;
    }
    return Done{};
  }

  Result<Done, InputError> plan_coding() {
    take_own();
    to_coded_channels(coefficients_, settings_.colour, settings_.threads);
    const auto functions = static_cast<std::size_t>(plan_.fit.basis.num_functions());
    std::vector<float> larger = coefficients_;
    for (float& c : larger) c *= kMargin;
    plan_.shift = component_shifts(larger, functions,
                                   std::min<std::size_t>(2 * cells_.store.size(), kMostBaseWeight));
    EncoderSettings settings = settings_;
    settings.fit = plan_.fit;
    encoded_.q = settings.q;
    encoded_.grid = moved(plan_.grid, plan_.origin);
    encoded_.density = density_;
    encoded_.fit = fit_.chosen;
    encoded_.fit.settings = plan_.fit;
    encoded_.cameras = plan_.trust;
    settings.metadata = plan_.metadata;
    plan_.metadata = encoder_metadata(settings, encoded_, plan_.cameras.size());
    return settings_.transform == TransformMode::kNone ? Result<Done, InputError>(Done{})
                                                       : plan_transforms(settings);
  }

 private:
  std::vector<float> colours() const {
    std::vector<float> all;
    for (const auto& rgb : region_.cloud.colours) all.insert(all.end(), rgb.begin(), rgb.end());
    return all;
  }

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
  Result<Done, InputError> fit_sample() {
    const VoxelCloud& cloud = region_.cloud;
    SLF_TRY(const DepthMaps maps,
            DepthMaps::in(work_.directory, capture_, cells_, plan_, settings_));
    const DepthOfCamera depth_of = [&](int camera) { return maps.of(camera); };
    const std::vector<int> cameras = cameras_of(capture_, plan_.cameras, cells_, sample_);
    SLF_TRY(SeenPoints seen, observe_points(capture_, cameras, world_points(cloud), depth_of,
                                            settings_.observe, progress_));
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
    const Observations framed =
        in_frame(world, chosen.frame, cloud.positions, chosen.normal_cell_log2, settings_.threads);
    chosen.environment.known = known_light(framed, cloud.positions, chosen);
    if (chosen.environment.known.half == 0) chosen.environment.degree = 0;
    SLF_CHECK(fit_chosen({capture_, cameras, cloud, depth_of}, std::move(world), settings_,
                         progress_, fit_));
    plan_.fit = chosen;
    plan_.gamma_min_q7 = fit_.gamma_min_q7;
    plan_.gamma_max_q7 = fit_.gamma_max_q7;
    coefficients_ = std::move(fit_.coefficients);
    return Done{};
  }

  /// Coefficients and positions of the sampled cells alone.
  void take_own() {
    const std::size_t row =
        coefficients_.size() / std::max<std::size_t>(region_.cloud.positions.size(), 1);
    std::vector<float> own;
    for (const std::uint32_t p : region_.own) {
      const auto begin = coefficients_.begin() + static_cast<std::ptrdiff_t>(p * row);
      own.insert(own.end(), begin, begin + static_cast<std::ptrdiff_t>(row));
      codes_.push_back(morton(region_.cloud.positions[p]));
    }
    coefficients_ = std::move(own);
  }

  Result<Done, InputError> plan_transforms(const EncoderSettings& settings) {
    LightField field = scene_header(plan_, settings);
    const CodingParameters parameters = coding_parameters(field, settings);
    SLF_TRY(const SequenceParameterSet set, sequence_of(field, parameters));
    const auto components = to_components(coefficients_, plan_.shift, settings.threads);
    const std::vector<SliceCut> cuts = {{0, 0, codes_.size()}};
    const double scale = static_cast<double>(cells_.store.size()) /
                         static_cast<double>(std::max<std::size_t>(codes_.size(), 1));
    for (const ForwardTransform& t : derive_transforms(
             {codes_, components, cuts, scale}, plane_groups(set), error_weights(field.header),
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
  std::vector<float> coefficients_;   // [points of the region][3 K], later of own ones
  std::vector<std::uint64_t> codes_;  // of own ones
};

Result<Done, InputError> check_memory(const ScenePlan& plan, const SceneWork& work,
                                      std::uint32_t slice_points) {
  if (const SceneCost cost = cost_of(plan); cost.memory > work.memory)
    return InputError{Errc::kLimitExceeded,
                      "a slice takes " + std::to_string(cost.memory >> 20) + " MiB, more than " +
                          std::to_string(work.memory >> 20) +
                          " of --memory: fewer --slice-points than " +
                          std::to_string(slice_points) + ", or more memory, would do"};
  return Done{};
}

}  // namespace

Result<ScenePlan, InputError> plan_scene(const Capture& capture, std::span<const int> cameras,
                                         const GivenSettings& given, const Metadata& metadata,
                                         const SceneWork& work, const Progress& progress) {
  SLF_TRY(const EncoderSettings settings,
          scene_settings(given, !capture.cameras.empty(), work.threads));
  SLF_CHECK(check_settings(settings));
  std::error_code error;
  std::filesystem::create_directories(work.directory, error);
  if (error) return InputError{Errc::kUnwritable, work.directory.string() + ": " + error.message()};
  ScenePlan plan;
  plan.settings = given;
  plan.metadata = metadata;
  plan.cameras.assign(cameras.begin(), cameras.end());
  std::sort(plan.cameras.begin(), plan.cameras.end());
  plan.capture_cameras = capture.cameras.size();
  plan.origin = capture.origin;
  plan.up = capture.up;
  if (cameras.empty() && capture.cloud.colours.empty())
    return InputError{Errc::kInvalidInput,
                      "the capture has no cameras and its points have no colours"};
  Planner planner(capture, settings, work, progress, plan);
  SLF_CHECK(planner.plan_points());
  plan.fit = settings.fit;
  SLF_CHECK(check_memory(plan, work, settings.max_slice_points));
  SLF_CHECK(planner.plan_fit());
  SLF_CHECK(planner.plan_coding());
  return plan;
}

}  // namespace slf
