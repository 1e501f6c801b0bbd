#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "lightfield/environment.h"
#include "lightfield/fit_hierarchical.h"
#include "lightfield/fit_neighbours.h"
#include "lightfield/fit_step.h"
#include "lightfield/fit_unobserved.h"
#include "lightfield/frame.h"
#include "lightfield/harmonics.h"
#include "slf/fit.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kPointsPerRange = 256;

Result<Done, InputError> invalid(const char* message) {
  return InputError{Errc::kInvalidArgument, message};
}

bool in_range(int value, int low, int high) { return value >= low && value <= high; }

Result<Done, InputError> check(const FitSettings& settings) {
  const Basis& basis = settings.basis;
  const HierarchySettings& h = settings.hierarchy;
  const auto sound = [](double value, double least) {
    return value >= least && std::isfinite(value);
  };
  if (settings.method == FitMethod::kHierarchical &&
      !(in_range(h.block_log2, 0, 21) && sound(h.strength, 1e-9) && sound(h.growth, 1) &&
        sound(h.point_penalty, 1e-9) && sound(h.point_growth, 1)))
    return invalid("block side 0 .. 21, strengths above 0, growths 1 or more");
  const EnvironmentSettings& e = settings.environment;
  if (settings.method == FitMethod::kHierarchical &&
      !(in_range(e.degree, 0, kMaxEnvironmentDegree) && sound(e.strength, 1e-9) &&
        (e.radius == 0 || sound(e.radius, kLeastEnvironmentRadius))))
    return invalid("environment: degree 0 .. 16, radius 0 or 2 and more, strength above 0");
  if (basis.id == BasisId::kHarmonics && !in_range(basis.degree, 0, kMaxDegree))
    return invalid("the degree of the basis must be 0 .. 10");
  if (basis.id == BasisId::kHarmonics && settings.method == FitMethod::kPaper)
    return invalid("the paper's fit takes B-splines, not harmonics");
  if (!in_range(basis.order, 1, 4)) return invalid("the order of the basis must be 1 .. 4");
  if (!in_range(basis.scales_theta, 0, 6) || !in_range(basis.scales_gamma, 0, 6))
    return invalid("the scales of the basis must be 0 .. 6");
  if (!(settings.lambda >= 0 && std::isfinite(settings.lambda)))
    return invalid("lambda must be 0 or more");
  if (!(settings.beta >= 0 && std::isfinite(settings.beta)))
    return invalid("beta must be 0 or more");
  if (!in_range(settings.iterations, 0, 100)) return invalid("iterations must be 0 .. 100");
  if (!in_range(settings.neighbours, 1, 64)) return invalid("neighbours must be 1 .. 64");
  return Done{};
}

Result<Done, InputError> check(const Observations& seen, std::size_t points) {
  const std::size_t total = seen.direction.size();
  if (points > std::numeric_limits<std::uint32_t>::max())
    return invalid("more than 2^32 - 1 points");
  if (seen.first.size() != points + 1 || seen.first.front() != 0 || seen.first.back() != total ||
      seen.colour.size() != total || !std::is_sorted(seen.first.begin(), seen.first.end()))
    return invalid("the observations do not belong to these points");
  if (total == 0) return InputError{Errc::kInvalidInput, "no point has an observation"};
  return Done{};
}

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

Observations in_frame(Observations observations, FrameId frame, std::span<const Voxel> positions,
                      int threads) {
  const auto normals = frame_normals(frame, positions, threads);
  if (normals.empty()) return observations;
  parallel_ranges(positions.size(), kPointsPerRange, threads,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t p = begin; p < end; ++p)
                      for (auto i = observations.first[p]; i < observations.first[p + 1]; ++i)
                        observations.direction[i] = to_frame(normals, p, observations.direction[i]);
                  });
  float low = 1, high = -1;
  for (const auto& direction : observations.direction) {
    low = std::min(low, direction[1]);
    high = std::max(high, direction[1]);
  }
  observations.gamma_min = static_cast<double>(low);
  observations.gamma_max = static_cast<double>(high);
  return observations;
}

// Paper, Algorithm 1.
Result<std::vector<float>, InputError> fit_view_maps(const Observations& observations,
                                                     std::span<const Voxel> positions,
                                                     const FitSettings& settings,
                                                     const Progress& progress) {
  const std::size_t points = positions.size();
  SLF_TRY([[maybe_unused]] const Done settings_checked, check(settings));
  SLF_TRY([[maybe_unused]] const Done shape_checked, check(observations, points));
  const Neighbours neighbours =
      nearest_neighbours(positions, settings.neighbours, settings.threads);
  const UnobservedPoints unobserved(observations, positions, neighbours, settings.threads);
  const std::size_t size = 3 * static_cast<std::size_t>(settings.basis.num_functions());
  if (settings.method == FitMethod::kHierarchical) {
    auto coefficients = fit_hierarchical(observations, positions, settings, progress);
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
