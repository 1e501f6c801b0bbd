// SPDX-License-Identifier: Apache-2.0
// The axis along which the surface in a block is projected. Spec 8.11.2.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/block_grid.h"

namespace slf {

/// [blocks] 0, 1, 2 for x, y, z. morton: the points of `grid`. O(P + 27 blocks).
std::vector<std::uint8_t> block_axes(const BlockGrid& grid, std::span<const std::uint64_t> morton);

}  // namespace slf
