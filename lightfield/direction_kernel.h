// How far what is seen of a point along one direction tells what is seen along another.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "lightfield/direction_rows.h"
#include "slf/types.h"

namespace slf {

/// A view map with the prior sum_k penalty_k a_k^2, b_k of mean square 1, has along directions u
/// and v the covariance sum_k b_k(u) b_k(v) / penalty_k. Of harmonics with a penalty per degree
/// that is a function of u . v alone (the addition theorem), which frames do not change: a table.
class DirectionKernel {
 public:
  /// @param rows  kept by reference
  /// @param penalty  [K] > 0; of harmonics the same for all of a degree
  DirectionKernel(const Basis& basis, const DirectionRows& rows, std::span<const double> penalty);

  /// One point's: from its M directions to a symmetric [M][M].
  /// @param world  [M] unit vectors to the cameras
  /// @param in_frame  [M] the same in the point's frame; read where the basis is not harmonics
  void matrix(std::span<const std::array<float, 3>> world,
              std::span<const std::array<float, 2>> in_frame, std::vector<float>& kernel) const;

  bool needs_frame() const { return table_.empty(); }

 private:
  static constexpr std::size_t kSteps = 4096;
  const DirectionRows& rows_;
  std::vector<float> inverse_root_;  // [K]
  std::vector<float> table_;         // [kSteps + 2] over u . v from -1 to 1; empty: no harmonics
};

}  // namespace slf
