// SPDX-License-Identifier: Apache-2.0
// The hierarchical fit.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "encoder/fit/block_prior.h"
#include "encoder/fit/direction_rows.h"
#include "encoder/fit/environment_prior.h"
#include "slf/fit.h"

namespace slf {

/// The fit of what the environment leaves, in two steps: sums, which strengths do not change, and
/// the solution for given strengths.
class HierarchicalFit {
 public:
  /// @param observations  of local directions; kept by reference, as positions are
  HierarchicalFit(const Observations& observations, std::span<const Voxel> positions,
                  const FitSettings& settings, const EnvironmentPrior& environment,
                  const Progress& progress = {});

  const DirectionRows& basis() const { return basis_; }

  /// Calls body(p, a), in parallel, for every point that was seen, with a [tried][K][3] of
  /// functions of mean square 1; without what the environment gives.
  /// @param tried  one at least; they may differ in what blocks have, for points share a system
  using Body = std::function<void(std::size_t point, std::span<const float> a)>;
  void solve(std::span<const HierarchySettings> tried, const Body& body,
             const Progress& progress = {}) const;

 private:
  template <class Each>
  void for_points(double from, double to, const Progress& progress, const Each& each) const;

  const Observations& observations_;
  std::span<const Voxel> positions_;
  std::vector<float> light_;  // [observations][3] what is subtracted from the colours; empty: 0
  int threads_;
  DirectionRows basis_;
  BlockPrior prior_;
};

/// [P][K][3]; points without observations have what the environment gives, and no mean.
/// @param observations  of local directions
std::vector<float> fit_hierarchical(const Observations& observations,
                                    std::span<const Voxel> positions, const FitSettings& settings,
                                    const Progress& progress);

}  // namespace slf
