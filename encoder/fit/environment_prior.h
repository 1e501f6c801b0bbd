// SPDX-License-Identifier: Apache-2.0
// What the environment tells of the points of the hierarchical fit.
#pragma once

#include <optional>
#include <vector>

#include "encoder/fit/direction_rows.h"
#include "encoder/fit/environment.h"
#include "encoder/fit/environment_fit.h"
#include "encoder/fit/fitted_rows.h"
#include "encoder/fit/pointwise_observations.h"

namespace slf {

/// Thread-safe. Without light it tells nothing.
class EnvironmentPrior {
 public:
  /// @param light, points  kept by reference; points may be empty without light
  EnvironmentPrior(const std::optional<Environment>& light, const MirrorPoints& points,
                   Directions directions)
      : light_(light), points_(points), directions_(directions) {}

  /// What point p reflects along a local direction.
  std::array<float, 3> operator()(std::size_t p, const std::array<float, 2>& direction) const;

  /// [observations][3] what it tells along each; empty without light.
  std::vector<float> along(const PointwiseObservations& seen, int threads) const;

  /// Its part of the view maps, of functions of mean square 1. Only with light.
  /// @param rows  [P][K][3] receives it
  void project(const PointwiseObservations& seen, const DirectionRows& basis, int threads,
               FittedRows& rows) const;

 private:
  const std::optional<Environment>& light_;
  const MirrorPoints& points_;
  Directions directions_;
};

}  // namespace slf
