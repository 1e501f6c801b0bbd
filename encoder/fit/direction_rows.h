// SPDX-License-Identifier: Apache-2.0
// The functions of a basis along directions, scaled to mean square 1: what the hierarchical fit
// works in, whatever the basis.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "lightfield/basis_table.h"
#include "lightfield/harmonics.h"
#include "slf/types.h"

namespace slf {

/// Thread-safe once made.
class DirectionRows {
 public:
  explicit DirectionRows(const Basis& basis);

  std::size_t size() const { return norms_.size(); }

  /// @param direction  (theta, gamma), local
  /// @param row  receives size() values b_k / ||b_k||; element 0 is 1
  void evaluate(const std::array<float, 2>& direction, float* row) const;

  /// Rows of many local unit vectors, faster where there are eight.
  /// @param rows  receives [directions][size()]
  void evaluate(std::span<const Vec3> directions, float* rows) const;

  /// Columns of (theta, gamma), local, at least one, side by side.
  /// @param columns  receives [size()][stride]; stride: a multiple of Harmonics::kLanes, at least
  ///                 the number of directions. What is behind it repeats the last.
  void evaluate_columns(std::span<const std::array<float, 2>> directions, float* columns,
                        std::size_t stride) const;

  /// [K] ||b_k||: a coefficient of b_k / ||b_k||, over it, is one of b_k.
  const std::vector<double>& norms() const { return norms_; }

  /// [K] How fine a function is: a harmonic's degree, the sum of a wavelet's scales. 0: constant.
  const std::vector<int>& fineness() const { return fineness_; }

 private:
  Basis basis_;
  Harmonics harmonics_;
  AxisTable theta_, gamma_;
  std::vector<double> norms_;
  std::vector<int> fineness_;
};

}  // namespace slf
