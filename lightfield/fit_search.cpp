// Settings of the hierarchical fit by cross-validation: choose_fit of slf/fit.h.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "geometry/morton.h"
#include "lightfield/camera_folds.h"
#include "lightfield/fit_hierarchical.h"
#include "lightfield/fit_settings.h"
#include "lightfield/frame.h"

namespace slf {
namespace {

constexpr std::size_t kMostViewsOfLight = 60000;
constexpr std::size_t kLeastCameras = 8;
constexpr int kLeastFolds = 3;
constexpr double kLeastGain = 0.005;
constexpr double kLeastStructureGain = 0.03, kSureStructureGain = 0.15;
constexpr std::array kStrengths = {0.1, 0.3, 1.0};  // 3 looks better than it is: docs/rate.md
constexpr std::array kGrowths = {1.15, 1.3, 1.5};
constexpr double kPenaltyRaise = 5;

/// Some of the points, with what was seen of them in world directions.
struct Sample {
  std::vector<Voxel> positions;
  MirrorPoints points;
  Observations seen;
};

/// The observations that `kept` tells to keep: a camera's index is its argument.
template <class Kept>
void append(const Observations& from, std::size_t point, const Kept& kept, Observations& to) {
  for (auto j = from.first[point]; j < from.first[point + 1]; ++j) {
    if (!kept(from.camera[j])) continue;
    to.direction.push_back(from.direction[j]);
    to.colour.push_back(from.colour[j]);
    to.camera.push_back(from.camera[j]);
  }
  to.first.push_back(to.direction.size());
}

/// Whole blocks, every n-th: priors of blocks stay what they are.
Sample sample_blocks(const Observations& seen, std::span<const Voxel> positions,
                     const MirrorPoints& points, int block_log2, std::size_t about) {
  const std::size_t every = (positions.size() + about - 1) / about;
  Sample sample;
  sample.seen.first.push_back(0);
  std::size_t block = 0;
  std::optional<std::uint64_t> last;
  for (std::size_t p = 0; p < positions.size(); ++p) {
    const std::uint64_t code = morton(positions[p]) >> (3 * block_log2);
    if (last && *last != code) ++block;
    last = code;
    if (block % every != every / 2) continue;
    sample.positions.push_back(positions[p]);
    sample.points.position.push_back(points.position[p]);
    sample.points.normal.push_back(points.normal[p]);
    append(
        seen, p, [](std::uint16_t) { return true; }, sample.seen);
  }
  return sample;
}

/// The observations of one fold, or of all others.
Observations of_fold(const Observations& seen, const CameraFolds& folds, int fold, bool others) {
  Observations part;
  part.first.push_back(0);
  for (std::size_t p = 0; p + 1 < seen.first.size(); ++p)
    append(
        seen, p, [&](std::uint16_t c) { return (folds.of_camera[c] == fold) != others; }, part);
  set_gamma_range(part);
  return part;
}

struct HeldOutError {
  double squared = 0;
  std::size_t samples = 0;

  double mean() const { return samples > 0 ? squared / static_cast<double>(samples) : 0; }
};

/// A fit without one fold.
class FoldFit {
 public:
  /// @param seen     of the directions of settings.frame
  /// @param light    of the other folds
  /// @param project  the light as functions of the basis, as a decoder has it; slow
  FoldFit(const Sample& sample, const Observations& seen, const CameraFolds& folds, int fold,
          const std::optional<Environment>& light, bool project, const FitSettings& settings)
      : kept_(of_fold(seen, folds, fold, true)),
        held_out_(of_fold(seen, folds, fold, false)),
        bspline_(settings.basis.id == BasisId::kBspline),
        environment_(light, sample.points, settings.frame),
        fit_(kept_, sample.positions, settings, environment_) {
    if (project && light) {
      projected_ = environment_.projected(kept_, fit_.basis(), settings.threads);
    } else {
      light_ = environment_.along(held_out_, settings.threads);
    }
  }

  /// Of each of the settings tried; see HierarchicalFit::solve.
  std::vector<HeldOutError> errors(std::span<const HierarchySettings> tried) const {
    const std::size_t points = held_out_.first.size() - 1;
    std::vector<double> of_point(points * tried.size(), 0);
    std::vector<std::size_t> count(points, 0);
    fit_.solve(tried, [&](std::size_t p, std::span<const float> a) {
      add_point_errors(p, a, std::span(of_point).subspan(p * tried.size(), tried.size()));
      count[p] = 3 * static_cast<std::size_t>(held_out_.first[p + 1] - held_out_.first[p]);
    });
    std::vector<HeldOutError> sums(tried.size());
    for (std::size_t p = 0; p < points; ++p)
      for (std::size_t t = 0; t < tried.size(); ++t) {
        sums[t].squared += of_point[p * tried.size() + t];
        sums[t].samples += count[p];
      }
    return sums;
  }

 private:
  /// @param a  [sums][K][3]
  void add_point_errors(std::size_t p, std::span<const float> a, std::span<double> sums) const {
    const std::size_t k = fit_.basis().size();
    std::vector<float> row(k);
    for (auto j = held_out_.first[p]; j < held_out_.first[p + 1]; ++j) {
      auto d = held_out_.direction[j];
      std::array<float, 3> light{0, 0, 0};
      if (!light_.empty()) std::copy_n(&light_[3 * j], 3, light.begin());
      if (bspline_)  // spec 6.7: held beyond what was seen
        d[1] = std::clamp(d[1], static_cast<float>(kept_.gamma_min),
                          static_cast<float>(kept_.gamma_max));
      fit_.basis().evaluate(d, row.data());
      for (std::size_t t = 0; t < sums.size(); ++t) {
        std::array<float, 3> value = light;
        for (std::size_t i = 0; i < k; ++i)
          for (std::size_t c = 0; c < 3; ++c) {
            value[c] += row[i] * a[3 * (t * k + i) + c];
            if (!projected_.empty()) value[c] += row[i] * projected_[3 * (p * k + i) + c];
          }
        for (std::size_t c = 0; c < 3; ++c) {
          const double e = double(std::clamp(value[c], 0.0f, 255.0f) - held_out_.colour[j][c]);
          sums[t] += e * e;
        }
      }
    }
  }

  Observations kept_, held_out_;
  bool bspline_;
  EnvironmentPrior environment_;
  HierarchicalFit fit_;
  std::vector<float> projected_, light_;  // at most one; light_: [held_out_][3]
};

double mean(const std::vector<HeldOutError>& of_fold) {
  HeldOutError sum;
  for (const HeldOutError& e : of_fold) {
    sum.squared += e.squared;
    sum.samples += e.samples;
  }
  return sum.mean();
}

/// Fits without each fold, of one frame and one basis.
class Trial {
 public:
  Trial(const Sample& sample, const CameraFolds& folds,
        const std::vector<std::optional<Environment>>& lights, bool project,
        const FitSettings& settings) {
    const Observations seen = settings.frame == FrameId::kReflected
                                  ? in_frame(sample.seen, sample.points.normal, settings.threads)
                                  : sample.seen;
    for (int fold = 0; fold < folds.count; ++fold)
      fits_.push_back(std::make_unique<FoldFit>(
          sample, seen, folds, fold, lights[static_cast<std::size_t>(fold)], project, settings));
  }

  /// [tried][fold]; see HierarchicalFit::solve.
  std::vector<std::vector<HeldOutError>> errors(std::span<const HierarchySettings> tried) const {
    std::vector<std::vector<HeldOutError>> of_tried(tried.size());
    for (const auto& fit : fits_) {
      const auto of_fold = fit->errors(tried);
      for (std::size_t t = 0; t < tried.size(); ++t) of_tried[t].push_back(of_fold[t]);
    }
    return of_tried;
  }
  std::vector<HeldOutError> errors(const HierarchySettings& tried) const {
    return errors(std::span(&tried, 1)).front();
  }

 private:
  std::vector<std::unique_ptr<FoldFit>> fits_;
};

/// Of the harmonics' order of magnitude.
Basis comparable_bspline(const Basis& harmonics) {
  const int scales = static_cast<int>(std::lround(std::log2(harmonics.num_functions())));
  return {BasisId::kBspline, harmonics.order, scales - scales / 2, scales / 2};
}

class Search {
 public:
  Search(const Sample& sample, const CameraFolds& folds, bool project, const FitSettings& given,
         const Progress& progress)
      : sample_(sample), folds_(folds), project_(project), best_(given), progress_(progress) {
    FitSettings world = given;
    world.frame = FrameId::kGlobal;
    for (int fold = 0; fold < folds.count; ++fold)
      lights_.push_back(fit_environment(of_fold(sample.seen, folds, fold, true), sample.points,
                                        world, kMostViewsOfLight));
    trial_ = make_trial(best_);
    errors_ = trial_->errors(best_.hierarchy);
    given_error_ = mean(errors_);
    tell();
  }

  void try_structure(FrameId frame, const Basis& basis) {
    FitSettings settings = best_;
    settings.frame = frame;
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
  std::unique_ptr<Trial> make_trial(const FitSettings& settings) const {
    return std::make_unique<Trial>(sample_, folds_, lights_, project_, settings);
  }
  void tell() {
    constexpr double kMostTrials = 6;
    if (progress_) progress_("choose", std::min(1.0, ++trials_ / kMostTrials));
  }

  const Sample& sample_;
  const CameraFolds& folds_;
  bool project_;
  FitSettings best_;
  const Progress& progress_;
  std::vector<std::optional<Environment>> lights_;
  std::unique_ptr<Trial> trial_;
  std::vector<HeldOutError> errors_;  // of best_, by fold
  double given_error_ = 0;
  int trials_ = 0;
};

double psnr(double mean_squared_error) {
  return 10 * std::log10(255.0 * 255.0 / std::max(mean_squared_error, 1e-9));
}

}  // namespace

Result<ChosenFit, InputError> choose_fit(const Observations& observations,
                                         std::span<const Voxel> positions,
                                         const FitSettings& settings, const FitSearch& search,
                                         const Progress& progress) {
  SLF_CHECK(check_fit_settings(settings));
  SLF_CHECK(check_observations(observations, positions.size()));
  ChosenFit chosen{settings};
  if (settings.method != FitMethod::kHierarchical) {
    if (!search.any()) return chosen;
    return InputError{Errc::kInvalidArgument, "cross-validation is of the hierarchical fit"};
  }
  if (settings.environment.degree == 0 && !search.any()) return chosen;
  const MirrorPoints points = mirror_points(positions, settings.normal_cell_log2, settings.threads);
  FitSettings world = settings;
  world.frame = FrameId::kGlobal;
  chosen.settings.environment = with_radius(observations, points, world);
  if (!search.any()) return chosen;

  const CameraFolds folds = camera_folds(observations, {});
  if (folds.cameras < kLeastCameras || folds.count < kLeastFolds) {
    chosen.outcome = ChosenFit::kTooFewCameras;
    return chosen;
  }
  const Sample sample =
      sample_blocks(observations, positions, points, settings.hierarchy.block_log2, search.points);
  Search found(sample, folds, search.basis, chosen.settings, progress);
  if (search.strength) found.try_values(&HierarchySettings::strength, kStrengths);
  if (search.growth) found.try_values(&HierarchySettings::growth, kGrowths);
  if (search.point_penalty)
    found.try_values(&HierarchySettings::point_penalty,
                     std::array{kPenaltyRaise * settings.hierarchy.point_penalty});
  // Last: priors that are too weak take the wrong side.
  const bool reflected = settings.frame == FrameId::kReflected;
  if (search.frame)
    found.try_structure(reflected ? FrameId::kGlobal : FrameId::kReflected, settings.basis);
  if (search.basis && settings.basis.id == BasisId::kHarmonics)
    found.try_structure(found.best().frame, comparable_bspline(settings.basis));
  chosen.settings = found.best();
  chosen.outcome = ChosenFit::kSearched;
  chosen.psnr_given = psnr(found.given_error());
  chosen.psnr_chosen = psnr(found.error());
  return chosen;
}

}  // namespace slf
