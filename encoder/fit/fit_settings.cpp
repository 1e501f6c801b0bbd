// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/fit_settings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/input_error.h"
#include "encoder/fit/environment.h"
#include "lightfield/harmonics.h"

namespace slf {
namespace {

bool in_range(int value, int low, int high) { return value >= low && value <= high; }

}  // namespace

Result<Done, InputError> check_fit_settings(const FitSettings& settings) {
  const Basis& basis = settings.basis;
  const HierarchySettings& h = settings.hierarchy;
  const auto sound = [](double value, double least) {
    return value >= least && std::isfinite(value);
  };
  if (settings.method == FitMethod::kHierarchical &&
      !(in_range(h.block_log2, 0, 21) && sound(h.strength, 1e-9) && sound(h.growth, 1) &&
        sound(h.point_penalty, 1e-9) && sound(h.point_growth, 1)))
    return invalid_argument("block side 0 .. 21, strengths above 0, growths 1 or more");
  const EnvironmentSettings& e = settings.environment;
  if (settings.method == FitMethod::kHierarchical &&
      !(in_range(e.degree, 0, kMaxEnvironmentDegree) && sound(e.strength, 1e-9) &&
        (e.radius == 0 || sound(e.radius, kLeastEnvironmentRadius))))
    return invalid_argument(
        "environment: degree 0 .. 16, radius 0 or 2 and more, strength above 0");
  const PictureFitSettings& p = settings.pictures;
  if (!in_range(p.rounds, 0, 20) || !in_range(p.steps, 1, 100))
    return invalid_argument("picture fit: 0 .. 20 rounds of 1 .. 100 steps");
  if (!(sound(p.mean_penalty, 1e-6) && sound(p.penalty, 1e-6) && sound(p.growth, 1) &&
        sound(p.outlier, 1e-3)))
    return invalid_argument("picture fit: penalties and outlier above 0, growth 1 or more");
  if (basis.id == BasisId::kHarmonics && !in_range(basis.degree, 0, kMaxDegree))
    return invalid_argument("the degree of the basis must be 0 .. 10");
  if (basis.id == BasisId::kHarmonics && settings.method == FitMethod::kPaper)
    return invalid_argument("the paper's fit takes B-splines, not harmonics");
  if (!in_range(basis.order, 1, 4))
    return invalid_argument("the order of the basis must be 1 .. 4");
  if (!in_range(basis.scales_theta, 0, 6) || !in_range(basis.scales_gamma, 0, 6))
    return invalid_argument("the scales of the basis must be 0 .. 6");
  if (!(settings.lambda >= 0 && std::isfinite(settings.lambda)))
    return invalid_argument("lambda must be 0 or more");
  if (!(settings.beta >= 0 && std::isfinite(settings.beta)))
    return invalid_argument("beta must be 0 or more");
  if (!in_range(settings.iterations, 0, 100))
    return invalid_argument("iterations must be 0 .. 100");
  if (!in_range(settings.neighbours, 1, 64)) return invalid_argument("neighbours must be 1 .. 64");
  return Done{};
}

Result<Done, InputError> check_observations(const Observations& seen, std::size_t points) {
  const std::size_t total = seen.direction.size();
  if (points > std::numeric_limits<std::uint32_t>::max())
    return invalid_argument("more than 2^32 - 1 points");
  if (seen.first.size() != points + 1 || seen.first.front() != 0 || seen.first.back() != total ||
      seen.colour.size() != total || seen.camera.size() != total ||
      !std::is_sorted(seen.first.begin(), seen.first.end()))
    return invalid_argument("the observations do not belong to these points");
  if (total == 0) return InputError{Errc::kInvalidInput, "no point has an observation"};
  return Done{};
}

}  // namespace slf
