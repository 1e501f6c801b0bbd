// SPDX-License-Identifier: Apache-2.0
// Voxels with random observations, for tests of the fit to points.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "slf/fit.h"

namespace slf {

/// Voxels on a line with growing gaps (no ties but one), `counts[p]` random observations each.
struct RandomSightings {
  std::vector<Voxel> positions;
  Observations seen;
};

inline RandomSightings random_sightings(const std::vector<int>& counts, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> theta(-3.14f, 3.14f), gamma(-0.99f, 0.99f), grey(0, 255);
  RandomSightings scene;
  scene.seen.first.push_back(0);
  for (std::size_t p = 0; p < counts.size(); ++p) {
    const auto at = static_cast<std::int32_t>(p * (p + 3));
    scene.positions.push_back({at, 0, 0});
    for (int n = 0; n < counts[p]; ++n) {
      scene.seen.direction.push_back({theta(random), gamma(random)});
      scene.seen.colour.push_back({grey(random), grey(random), 200});
      scene.seen.camera.push_back(static_cast<std::uint16_t>(n));
    }
    scene.seen.first.push_back(scene.seen.direction.size());
  }
  return scene;
}

inline FitSettings paper_fit(const Basis& basis, int threads) {
  FitSettings settings;
  settings.basis = basis;
  settings.threads = threads;
  return settings;
}

}  // namespace slf
