// SPDX-License-Identifier: Apache-2.0
// Distances to a surface at the nodes of a lattice, kept near the surface alone: blocks of 8^3.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "capture/resample.h"
#include "capture/surface_points.h"

namespace slf {

inline constexpr int kBlockNodes = 8;
inline constexpr std::size_t kNodesOfBlock = 512;

using BlockKey = std::array<std::int32_t, 3>;

/// Weighted sums of distances; positive outside.
struct DistanceBlock {
  BlockKey key{};  ///< of its first node, in blocks
  std::array<float, kNodesOfBlock> distance{}, weight{};
};

struct DistanceBlocks {
  Lattice lattice;
  std::vector<DistanceBlock> blocks;  ///< ascending keys

  Float3 world(const BlockKey& block, int x, int y, int z) const {
    return {float(lattice.origin[0] + lattice.step * (block[0] * kBlockNodes + x)),
            float(lattice.origin[1] + lattice.step * (block[1] * kBlockNodes + y)),
            float(lattice.origin[2] + lattice.step * (block[2] * kBlockNodes + z))};
  }
  /// Nothing where there is none.
  const DistanceBlock* find(const BlockKey& key) const;
};

/// Nodes nearest to where the distance is 0, one layer of them. Smoothed over the nodes around.
/// @param least_weight  of a node that counts
SurfacePoints zero_crossings(const DistanceBlocks& distances, float least_weight, int threads);

/// Without pieces of fewer points than `least`; points are neighbours within sqrt(3) steps.
SurfacePoints without_debris(SurfacePoints points, const Lattice& lattice, std::size_t least);

}  // namespace slf
