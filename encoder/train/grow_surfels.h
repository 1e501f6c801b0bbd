// SPDX-License-Identifier: Apache-2.0
// Where surfels are too few they split; what nothing shows goes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "encoder/train/adam.h"
#include "encoder/train/draw_surfels.h"
#include "encoder/train/far_surfels.h"

namespace slf {

/// What pictures said of each surfel since it was last asked.
struct SurfelUse {
  std::vector<float> drawn, pull;  ///< [surfels] sums of ProjectedGradient's

  void resize(std::size_t surfels);
  void add(const SurfelTiles& tiles, const std::vector<ProjectedGradient>& gradients);
  void clear();
};

struct GrowSettings {
  std::size_t most = 0;     ///< surfels
  double share = 0.1;       ///< of the surfels: at most so many are added
  float least_opacity = 0;  ///< fainter ones go
  double replaced = 0;      ///< of `most`: those with the least pull make room for so many
  std::size_t axes = 2;     ///< that are split: 3 of ellipsoids
  float smallest = 0;       ///< world radius: no smaller ones split; far away larger
  ViewedSpace space = {};   ///< where a pixel is larger
  std::span<const std::uint8_t> moving = {};  ///< [surfels] 0: stays as it is; or none
  bool all_seen = false;  ///< every photograph was drawn since: what was not drawn goes
};

/// Leaves out others.
/// @param keep  [surfels] 0 or 1
void keep_surfels(std::span<const std::uint8_t> keep, SurfelUse& use, AdamState& state,
                  TrainedSurfels& surfels);

/// Splits across the longest axis those with the greatest pull, so that the two draw about what the
/// one did; removes those that show nothing, and the share that is replaced. Use is empty after.
void grow_surfels(const GrowSettings& settings, SurfelUse& use, AdamState& state,
                  TrainedSurfels& surfels);

}  // namespace slf
