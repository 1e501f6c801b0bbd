// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/fit_unobserved.h"

#include <algorithm>

#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kUnobservedPerRange = 256;

}  // namespace

void mean_coefficients(std::span<const std::uint32_t> points, const float* coefficients,
                       std::size_t size, float factor, float* mean) {
  std::fill_n(mean, size, 0.0f);
  for (const std::uint32_t point : points) {
    const float* from = coefficients + point * size;
    for (std::size_t i = 0; i < size; ++i) mean[i] += from[i];
  }
  factor /= static_cast<float>(points.size());
  for (std::size_t i = 0; i < size; ++i) mean[i] *= factor;
}

UnobservedPoints::UnobservedPoints(const Observations& observations,
                                   std::span<const Voxel> positions, const Neighbours& neighbours,
                                   int threads) {
  const auto observed = [&](std::size_t p) {
    return observations.first[p] != observations.first[p + 1];
  };
  std::vector<Voxel> observed_positions, lone_positions;
  std::vector<std::uint32_t> observed_points;
  std::vector<std::size_t> lone_donors;  // places in donors_ that the nearest observed point takes
  first_donor_.push_back(0);
  for (std::uint32_t p = 0; p < positions.size(); ++p) {
    if (observed(p)) {
      observed_points.push_back(p);
      observed_positions.push_back(positions[p]);
      continue;
    }
    points_.push_back(p);
    for (const std::uint32_t neighbour : neighbours.of(p))
      if (observed(neighbour)) donors_.push_back(neighbour);
    if (donors_.size() == first_donor_.back()) {
      lone_donors.push_back(donors_.size());
      lone_positions.push_back(positions[p]);
      donors_.push_back(p);
    }
    first_donor_.push_back(donors_.size());
  }
  if (lone_donors.empty()) return;
  const auto nearest = nearest_position(observed_positions, lone_positions, threads);
  for (std::size_t i = 0; i < nearest.size(); ++i)
    donors_[lone_donors[i]] = observed_points[nearest[i]];
}

void UnobservedPoints::fill(float* coefficients, std::size_t size, int threads) const {
  parallel_ranges(
      points_.size(), kUnobservedPerRange, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t u = begin; u < end; ++u) {
          const auto donors =
              std::span(donors_).subspan(first_donor_[u], first_donor_[u + 1] - first_donor_[u]);
          mean_coefficients(donors, coefficients, size, 1.0f, coefficients + points_[u] * size);
        }
      });
}

}  // namespace slf
