// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/fold_trial.h"

#include <algorithm>
#include <array>
#include <utility>

#include "encoder/fit/fit_cholesky.h"
#include "encoder/fit/lane_products.h"
#include "encoder/fit/local_observations.h"
#include "geometry/morton.h"

namespace slf {
namespace {

/// The observations that `kept` tells to keep: a camera's index is its argument.
template <class Kept>
void append_kept(const SeenPoint& from, const Kept& kept, Observations& to) {
  for (std::size_t j = 0; j < from.count(); ++j) {
    if (!kept(from.camera[j])) continue;
    to.direction.push_back(from.direction[j]);
    to.colour.push_back(from.colour[j]);
    to.camera.push_back(from.camera[j]);
  }
  to.first.push_back(to.direction.size());
}

}  // namespace

FoldSample sample_blocks(const PointwiseObservations& seen, std::span<const Voxel> positions,
                         const MirrorPoints& points, int block_log2, std::size_t about) {
  const std::size_t every = (positions.size() + about - 1) / about;
  FoldSample sample;
  SeenRoom room;
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
    append_kept(
        seen.of(p, room), [](std::uint16_t) { return true; }, sample.seen);
  }
  return sample;
}

Observations of_fold(const Observations& seen, const CameraFolds& folds, int fold, bool others) {
  Observations part;
  part.first.push_back(0);
  const PointwiseObservations all(seen);
  SeenRoom room;
  for (std::size_t p = 0; p < all.points(); ++p)
    append_kept(
        all.of(p, room), [&](std::uint16_t c) { return (folds.of_camera[c] == fold) != others; },
        part);
  set_gamma_range(part);
  return part;
}

/// A fit without one fold.
class FoldFit {
 public:
  /// @param seen     of the directions of settings.directions
  /// @param light    of the other folds
  /// @param project  the light as functions of the basis, as a decoder has it; slow
  FoldFit(const FoldSample& sample, const Observations& seen, const CameraFolds& folds, int fold,
          const std::optional<Environment>& light, bool project, const FitSettings& settings)
      : kept_(of_fold(seen, folds, fold, true)),
        held_out_(of_fold(seen, folds, fold, false)),
        bspline_(settings.basis.id == BasisId::kBspline),
        environment_(light, sample.points, settings.directions),
        fit_(kept_, sample.positions, settings, environment_) {
    if (project && light) {
      FittedRows rows(sample.positions.size(), 3 * fit_.basis().size());
      environment_.project(kept_, fit_.basis(), settings.threads, rows);
      projected_ = std::move(rows).take();
    } else {
      light_ = environment_.along(held_out_, settings.threads);
    }
  }

  /// One for each of the settings tried; see HierarchicalFit::solve_points.
  std::vector<FoldError> errors(std::span<const HierarchySettings> tried) const {
    const std::size_t points = held_out_.first.size() - 1;
    std::vector<double> of_point(points * tried.size(), 0);
    std::vector<std::size_t> count(points, 0);
    fit_.solve_points(
        tried, fit_.solve_blocks(tried), [&](std::size_t p, std::span<const float> a) {
          add_point_errors(p, a, std::span(of_point).subspan(p * tried.size(), tried.size()));
          count[p] = 3 * static_cast<std::size_t>(held_out_.first[p + 1] - held_out_.first[p]);
        });
    std::vector<FoldError> sums(tried.size());
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
    const std::size_t k = fit_.basis().size(), first = held_out_.first[p],
                      count = held_out_.first[p + 1] - first, stride = padded(count);
    if (count == 0) return;
    std::vector<std::array<float, 2>> directions(
        held_out_.direction.begin() + static_cast<std::ptrdiff_t>(first),
        held_out_.direction.begin() + static_cast<std::ptrdiff_t>(first + count));
    if (bspline_)  // spec 6.7: held beyond what was seen
      for (auto& d : directions)
        d[1] = std::clamp(d[1], static_cast<float>(kept_.gamma_min),
                          static_cast<float>(kept_.gamma_max));
    std::vector<float> functions(k * stride), values;
    fit_.basis().evaluate_columns(directions, functions.data(), stride);
    std::vector<Lanes<float>> of_point(k);
    for (std::size_t t = 0; t < sums.size(); ++t) {
      for (std::size_t i = 0; i < k; ++i)
        for (std::size_t c = 0; c < 3; ++c)
          of_point[i].c[c] = a[3 * (t * k + i) + c] +
                             (projected_.empty() ? 0.0f : projected_[3 * (p * k + i) + c]);
      values.assign(4 * stride, 0.0f);
      add_products(k, of_point[0].c.data(), 4, 4, functions.data(), stride, stride, values.data());
      for (std::size_t j = 0; j < count; ++j)
        for (std::size_t c = 0; c < 3; ++c) {
          const float value =
              values[c * stride + j] + (light_.empty() ? 0.0f : light_[3 * (first + j) + c]);
          const double e = double(std::clamp(value, 0.0f, 255.0f) - held_out_.colour[first + j][c]);
          sums[t] += e * e;
        }
    }
  }

  Observations kept_, held_out_;
  bool bspline_;
  EnvironmentPrior environment_;
  HierarchicalFit fit_;
  std::vector<float> projected_, light_;  // at most one; light_: [held_out_][3]
};

double mean(const std::vector<FoldError>& of_fold) {
  FoldError sum;
  for (const FoldError& e : of_fold) {
    sum.squared += e.squared;
    sum.samples += e.samples;
  }
  return sum.mean();
}

FoldTrial::FoldTrial(const FoldSample& sample, const CameraFolds& folds,
                     const std::vector<std::optional<Environment>>& lights, bool project,
                     const FitSettings& settings) {
  const Observations seen = settings.directions == Directions::kReflected
                                ? in_local(sample.seen, sample.points.normal, settings.threads)
                                : sample.seen;
  for (int fold = 0; fold < folds.count; ++fold)
    fits_.push_back(std::make_unique<FoldFit>(
        sample, seen, folds, fold, lights[static_cast<std::size_t>(fold)], project, settings));
}

FoldTrial::~FoldTrial() = default;

std::vector<std::vector<FoldError>> FoldTrial::errors(
    std::span<const HierarchySettings> tried) const {
  std::vector<std::vector<FoldError>> of_tried(tried.size());
  for (const auto& fit : fits_) {
    const auto of_fold = fit->errors(tried);
    for (std::size_t t = 0; t < tried.size(); ++t) of_tried[t].push_back(of_fold[t]);
  }
  return of_tried;
}
}  // namespace slf
