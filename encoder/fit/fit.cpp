// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include "encoder/fit/fit_hierarchical.h"
#include "encoder/fit/fit_neighbours.h"
#include "encoder/fit/fit_settings.h"
#include "encoder/fit/fit_step.h"
#include "encoder/fit/fit_unobserved.h"
#include "slf/fit.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kPointsPerRange = 256;

/// Runs body over all points and reports that step `step` of `steps` is under way.
template <class Body>
void for_points(std::size_t points, int step, int steps, const FitSettings& settings,
                const Progress& progress, const Body& body) {
  parallel_ranges(points, kPointsPerRange, settings.threads, body, [&](std::size_t done) {
    const double part = static_cast<double>(done) / static_cast<double>(points);
    if (progress) progress("fit", (step + part) / steps);
  });
}

}  // namespace

// Paper, Algorithm 1.
Result<std::vector<float>, InputError> fit_view_maps(const Observations& observations,
                                                     std::span<const Voxel> positions,
                                                     const FitSettings& settings,
                                                     const Progress& progress) {
  const std::size_t points = positions.size();
  SLF_CHECK(check_fit_settings(settings));
  SLF_CHECK(check_observations(observations, points));
  const Neighbours neighbours =
      nearest_neighbours(positions, settings.neighbours, settings.threads);
  const UnobservedPoints unobserved(observations, positions, neighbours, settings.threads);
  const std::size_t size = 3 * static_cast<std::size_t>(settings.basis.num_functions());
  if (settings.method == FitMethod::kHierarchical) {
    MirrorPoints mirrors;
    if (settings.environment.degree > 0)
      mirrors = mirror_points(positions, settings.normal_cell_log2, settings.threads,
                              settings.environment.known);
    auto coefficients =
        fit_hierarchical(observations, positions, mirrors, settings, points, progress).take();
    unobserved.fill(coefficients.data(), size, settings.threads);
    return coefficients;
  }
  // Without beta, or without a neighbour, Eq. 3 is Eq. 2.
  const int sweeps = settings.beta > 0 && neighbours.count > 0 ? settings.iterations : 0;

  std::vector<float> coefficients(points * size, 0.0f);
  {
    RidgeStep eq2(observations, settings, settings.lambda, 1);
    for_points(points, 0, 1 + sweeps, settings, progress, [&](std::size_t begin, std::size_t end) {
      eq2.solve(begin, end, coefficients.data());
    });
  }
  unobserved.fill(coefficients.data(), size, settings.threads);
  if (sweeps == 0) return coefficients;

  // Jacobi: a sweep reads only the coefficients before it, so that no order of points matters.
  RidgeStep eq3(observations, settings, settings.lambda + settings.beta, sweeps);
  const auto weight = static_cast<float>(settings.beta / (settings.lambda + settings.beta));
  std::vector<float> next(coefficients.size());
  for (int t = 1; t <= sweeps; ++t) {
    for_points(points, t, 1 + sweeps, settings, progress, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p)
        mean_coefficients(neighbours.of(p), coefficients.data(), size, weight,
                          next.data() + p * size);
      eq3.solve(begin, end, next.data());
    });
    unobserved.fill(next.data(), size, settings.threads);
    coefficients.swap(next);
  }
  return coefficients;
}

}  // namespace slf
