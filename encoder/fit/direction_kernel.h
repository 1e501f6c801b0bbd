// SPDX-License-Identifier: Apache-2.0
// How far what is seen of a point along one direction tells what is seen along another.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "encoder/fit/direction_rows.h"
#include "lightfield/harmonics.h"
#include "slf/types.h"

namespace slf {

/// R, G, B of whatever is summed, and a fourth that makes it a vector of the machine.
using Colour4 = std::array<float, 4>;

/// A view map with the prior sum_k penalty_k a_k^2, b_k of mean square 1, has along directions u
/// and v the covariance sum_k b_k(u) b_k(v) / penalty_k. Of harmonics with a penalty per degree
/// that is a polynomial in u . v (the addition theorem), local or of the world.
class DirectionKernel {
 public:
  /// @param rows  kept by reference
  /// @param penalty  [K] > 0; of harmonics the same for all of a degree
  DirectionKernel(const Basis& basis, const DirectionRows& rows, std::span<const double> penalty);

  /// Covariances of one point's M directions, times x.
  /// @param world  [M] unit vectors to the cameras
  /// @param in_local  [M] the same local to the point; read where needs_local()
  void apply(std::span<const std::array<float, 3>> world, std::span<const Vec3> in_local,
             std::span<const Colour4> x, std::span<Colour4> out) const;

  bool needs_local() const { return !zonal_; }

 private:
  void apply_rows(std::span<const Vec3> in_local, std::span<const Colour4> x,
                  std::span<Colour4> out) const;

  const DirectionRows& rows_;
  std::vector<float> inverse_;  // [K] 1 / penalty
  bool zonal_;
  std::array<float, kMaxDegree + 1> polynomial_{};  // of u . v
};

}  // namespace slf
