// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/local_observations.h"

#include <algorithm>
#include <utility>

#include "lightfield/directions.h"
#include "slf/parallel.h"

namespace slf {

void set_gamma_range(Observations& observations) {
  if (observations.direction.empty()) return;
  float low = 1, high = -1;
  for (const auto& direction : observations.direction) {
    low = std::min(low, direction[1]);
    high = std::max(high, direction[1]);
  }
  observations.gamma_min = static_cast<double>(low);
  observations.gamma_max = static_cast<double>(high);
}

Observations in_local(Observations observations, std::span<const std::array<float, 3>> normals,
                      int threads) {
  constexpr std::size_t kPointsAtOnce = 256;
  if (normals.empty()) return observations;
  parallel_ranges(normals.size(), kPointsAtOnce, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (auto i = observations.first[p]; i < observations.first[p + 1]; ++i)
        observations.direction[i] = to_local(normals, p, observations.direction[i]);
  });
  set_gamma_range(observations);
  return observations;
}

Observations in_local(Observations observations, Directions directions,
                      std::span<const Voxel> positions, int cell_log2, int threads) {
  return in_local(std::move(observations),
                  mirror_normals(directions, positions, cell_log2, threads), threads);
}

}  // namespace slf
