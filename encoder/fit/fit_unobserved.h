// SPDX-License-Identifier: Apache-2.0
// Colours for points that no camera saw.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "encoder/fit/fit_neighbours.h"
#include "slf/fit.h"

namespace slf {

/// mean = factor / n * (sum over the n points of their coefficients).
/// @param size  3 K: coefficients of a point
void mean_coefficients(std::span<const std::uint32_t> points, const float* coefficients,
                       std::size_t size, float factor, float* mean);

/// Every point without observations takes the mean of those of its neighbours that have some; where
/// none has, of the nearest point that has.
class UnobservedPoints {
 public:
  /// @param observations  of at least one point
  UnobservedPoints(const Observations& observations, std::span<const Voxel> positions,
                   const Neighbours& neighbours, int threads);

  /// @param coefficients  [P][size]
  void fill(float* coefficients, std::size_t size, int threads) const;

 private:
  std::vector<std::uint32_t> points_;     // ascending
  std::vector<std::size_t> first_donor_;  // [points + 1], into donors_
  std::vector<std::uint32_t> donors_;     // points with observations
};

}  // namespace slf
