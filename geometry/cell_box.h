// SPDX-License-Identifier: Apache-2.0
// Boxes of the index.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "bitstream/index.h"
#include "geometry/morton.h"

namespace slf {

/// @param cells  Morton codes of that grid; at least one
inline CellBox box_of_cells(std::span<const std::uint64_t> cells) {
  CellBox box{~0u, ~0u, ~0u, 0, 0, 0};
  for (const std::uint64_t cell : cells) {
    const Voxel place = from_morton(cell);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto coordinate = static_cast<std::uint32_t>(place[axis]);
      box[axis] = std::min(box[axis], coordinate);
      box[axis + 3] = std::max(box[axis + 3], coordinate);
    }
  }
  return box;
}

}  // namespace slf
