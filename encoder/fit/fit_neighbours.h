// SPDX-License-Identifier: Apache-2.0
// Nearest voxels, by exact integer distance, ties by index.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "slf/types.h"

namespace slf {

/// [queries.size()][count] indices into `positions`, nearest first; count = k, or all there are
/// where that is fewer.
struct Neighbours {
  std::size_t count = 0;
  std::vector<std::uint32_t> index;

  std::span<const std::uint32_t> of(std::size_t query) const {
    return {index.data() + query * count, count};
  }
};

/// The k nearest of `positions` to each of them, itself excluded. No two positions are equal.
Neighbours nearest_neighbours(std::span<const Voxel> positions, int k, int threads);

/// For each query the nearest of `positions` (at least one).
std::vector<std::uint32_t> nearest_position(std::span<const Voxel> positions,
                                            std::span<const Voxel> queries, int threads);

}  // namespace slf
