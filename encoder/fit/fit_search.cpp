// SPDX-License-Identifier: Apache-2.0
// Settings of the hierarchical fit by cross-validation.
#include "encoder/fit/fit_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "encoder/fit/fit_settings.h"
#include "encoder/fit/fold_trial.h"
#include "lightfield/directions.h"

namespace slf {
namespace {

constexpr std::size_t kMostViewsOfLight = 60000;
constexpr std::size_t kLeastCameras = 8;
constexpr int kLeastFolds = 3;
constexpr double kLeastGain = 0.005;
constexpr double kLeastStructureGain = 0.03, kSureStructureGain = 0.15;
constexpr std::array kStrengths = {0.1, 0.3, 1.0};  // 3 looks better than it is: docs/decisions/004
constexpr std::array kGrowths = {1.15, 1.3, 1.5};
constexpr double kPenaltyRaise = 5;

/// A basis of the harmonics' order of magnitude.
Basis comparable_bspline(const Basis& harmonics) {
  const int scales = static_cast<int>(std::lround(std::log2(harmonics.num_functions())));
  return {BasisId::kBspline, harmonics.order, scales - scales / 2, scales / 2};
}

class Search {
 public:
  Search(const FoldSample& sample, const CameraFolds& folds, bool project, const FitSettings& given,
         const Progress& progress)
      : sample_(sample), folds_(folds), project_(project), best_(given), progress_(progress) {
    FitSettings world = given;
    world.directions = Directions::kWorld;
    for (int fold = 0; fold < folds.count; ++fold)
      lights_.push_back(fit_environment(of_fold(sample.seen, folds, fold, true), sample.points,
                                        world, kMostViewsOfLight));
    trial_ = make_trial(best_);
    errors_ = trial_->errors(best_.hierarchy);
    given_error_ = mean(errors_);
    tell();
  }

  void try_structure(Directions directions, const Basis& basis) {
    FitSettings settings = best_;
    settings.directions = directions;
    settings.basis = basis;
    auto trial = make_trial(settings);
    auto now = trial->errors(best_.hierarchy);
    tell();
    bool everywhere = true;
    for (std::size_t fold = 0; fold < now.size(); ++fold)
      everywhere = everywhere && now[fold].mean() < errors_[fold].mean();
    const double gain = everywhere ? kLeastStructureGain : kSureStructureGain;
    if (!(mean(now) < (1 - gain) * mean(errors_))) return;
    best_ = settings;
    errors_ = std::move(now);
    trial_ = std::move(trial);
  }

  /// setting: of the blocks, or one candidate.
  void try_values(double HierarchySettings::*setting, std::span<const double> candidates) {
    std::vector<HierarchySettings> tried;
    for (const double value : candidates)
      if (value != best_.hierarchy.*setting) tried.emplace_back(best_.hierarchy).*setting = value;
    if (tried.empty()) return;
    const double before = mean(errors_);
    auto errors = trial_->errors(tried);
    tell();
    for (std::size_t t = 0; t < tried.size(); ++t) {
      if (!(mean(errors[t]) < (1 - kLeastGain) * before) || !(mean(errors[t]) < mean(errors_)))
        continue;
      best_.hierarchy = tried[t];
      errors_ = std::move(errors[t]);
    }
  }

  const FitSettings& best() const { return best_; }
  double given_error() const { return given_error_; }
  double error() const { return mean(errors_); }

 private:
  std::unique_ptr<FoldTrial> make_trial(const FitSettings& settings) const {
    return std::make_unique<FoldTrial>(sample_, folds_, lights_, project_, settings);
  }
  void tell() {
    constexpr double kMostTrials = 6;
    if (progress_) progress_("choose", std::min(1.0, ++trials_ / kMostTrials));
  }

  const FoldSample& sample_;
  const CameraFolds& folds_;
  bool project_;
  FitSettings best_;
  const Progress& progress_;
  std::vector<std::optional<Environment>> lights_;
  std::unique_ptr<FoldTrial> trial_;
  std::vector<FoldError> errors_;  // of best_, by fold
  double given_error_ = 0;
  int trials_ = 0;
};

double psnr_of_mean(double mean_squared_error) {
  return 10 * std::log10(255.0 * 255.0 / std::max(mean_squared_error, 1e-9));
}

}  // namespace

Result<ChosenFit, InputError> choose_fit(const Observations& observations,
                                         std::span<const Voxel> positions,
                                         const FitSettings& settings, const FitSearch& search,
                                         const Progress& progress) {
  SLF_CHECK(check_fit_settings(settings));
  SLF_CHECK(check_observations(observations, positions.size()));
  MirrorPoints points;
  if (chooses_fit(settings, search))
    points = mirror_points(positions, settings.normal_cell_log2, settings.threads);
  return choose_fit(PointwiseObservations(observations), positions, points, settings, search,
                    progress);
}

bool chooses_fit(const FitSettings& settings, const FitSearch& search) {
  return settings.method == FitMethod::kHierarchical &&
         (settings.environment.degree > 0 || search.any());
}

Result<ChosenFit, InputError> choose_fit(const PointwiseObservations& observations,
                                         std::span<const Voxel> positions,
                                         const MirrorPoints& points, const FitSettings& settings,
                                         const FitSearch& search, const Progress& progress) {
  SLF_CHECK(check_fit_settings(settings));
  ChosenFit chosen{settings};
  if (settings.method != FitMethod::kHierarchical) {
    if (!search.any()) return chosen;
    return InputError{Errc::kInvalidArgument, "cross-validation is of the hierarchical fit"};
  }
  if (!chooses_fit(settings, search)) return chosen;
  FitSettings world = settings;
  world.directions = Directions::kWorld;
  const CameraFolds folds = camera_folds(observations, {});
  chosen.settings.environment = with_radius(observations, points, world, folds);
  if (!search.any()) return chosen;

  if (folds.cameras < kLeastCameras || folds.count < kLeastFolds) {
    chosen.outcome = ChosenFit::kTooFewCameras;
    return chosen;
  }
  const FoldSample sample =
      sample_blocks(observations, positions, points, settings.hierarchy.block_log2, search.points);
  Search found(sample, folds, search.basis, chosen.settings, progress);
  if (search.strength) found.try_values(&HierarchySettings::strength, kStrengths);
  if (search.growth) found.try_values(&HierarchySettings::growth, kGrowths);
  if (search.point_penalty)
    found.try_values(&HierarchySettings::point_penalty,
                     std::array{kPenaltyRaise * settings.hierarchy.point_penalty});
  // Last: priors that are too weak take the wrong side.
  const bool reflected = settings.directions == Directions::kReflected;
  if (search.directions)
    found.try_structure(reflected ? Directions::kWorld : Directions::kReflected, settings.basis);
  if (search.basis && settings.basis.id == BasisId::kHarmonics)
    found.try_structure(found.best().directions, comparable_bspline(settings.basis));
  chosen.settings = found.best();
  chosen.outcome = ChosenFit::kSearched;
  chosen.psnr_given = psnr_of_mean(found.given_error());
  chosen.psnr_chosen = psnr_of_mean(found.error());
  return chosen;
}

}  // namespace slf
