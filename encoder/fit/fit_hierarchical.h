// SPDX-License-Identifier: Apache-2.0
// The hierarchical fit.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "encoder/fit/block_prior.h"
#include "encoder/fit/direction_rows.h"
#include "encoder/fit/environment_prior.h"
#include "encoder/fit/fitted_rows.h"
#include "encoder/fit/pointwise_observations.h"
#include "slf/fit.h"

namespace slf {

/// The fit of what the environment leaves, in three steps: sums, which strengths do not change, the
/// solutions of blocks for given strengths, and those of points.
class HierarchicalFit {
 public:
  /// @param observations  of local directions
  /// @param positions, environment  kept by reference
  HierarchicalFit(const PointwiseObservations& observations, std::span<const Voxel> positions,
                  const FitSettings& settings, const EnvironmentPrior& environment,
                  const Progress& progress = {});

  const DirectionRows& basis() const { return basis_; }

  /// [tried][finest blocks][K][3] of functions of mean square 1.
  /// @param tried  one at least; they may differ in what blocks have, for points share a system
  std::vector<std::vector<float>> solve_blocks(std::span<const HierarchySettings> tried) const;

  /// Gives up what solve_blocks needs: most of the memory of a fit.
  void forget_sums() { prior_.forget_sums(); }

  /// Calls body(p, a), in parallel, for every point that was seen, with a [tried][K][3] of
  /// functions of mean square 1; without what the environment gives.
  /// @param blocks  solve_blocks(tried)
  using Body = std::function<void(std::size_t point, std::span<const float> a)>;
  void solve_points(std::span<const HierarchySettings> tried,
                    std::span<const std::vector<float>> blocks, const Body& body,
                    const Progress& progress = {}) const;

 private:
  template <class Each>
  void for_points(double from, double to, const Progress& progress, const Each& each) const;

  PointwiseObservations observations_;
  std::span<const Voxel> positions_;
  const EnvironmentPrior& environment_;
  /// [observations][3] what is subtracted from the colours, where observations lie in memory too;
  /// else it is found again when they are made.
  std::vector<float> light_;
  int threads_;
  DirectionRows basis_;
  BlockPrior prior_;
};

/// [P][K][3]; points without observations have what the environment gives, and no mean.
/// @param observations  of local directions
/// @param points        mirror_points of settings; not read without an environment
/// @param of_piece      points of a piece of the result, > 0
FittedRows fit_hierarchical(const PointwiseObservations& observations,
                            std::span<const Voxel> positions, const MirrorPoints& points,
                            const FitSettings& settings, std::size_t of_piece,
                            const Progress& progress);

}  // namespace slf
