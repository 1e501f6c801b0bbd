// SPDX-License-Identifier: Apache-2.0
// Patches of a slice's surface that project to a plane one to one. Spec 8.11.3.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/block_grid.h"
#include "slf/types.h"

namespace slf {

/// Boxes of charts are measured, rounded up, and placed in steps of 4 pixels.
inline constexpr std::int32_t kBoxStep = 4;
constexpr std::int32_t in_box_steps(std::int32_t pixels) {
  return (pixels + kBoxStep - 1) / kBoxStep;
}

struct Chart {
  std::uint8_t axis = 0;                 ///< of projection
  std::array<std::int32_t, 2> least{};   ///< least (u, v) of its cells
  std::array<std::int32_t, 2> extent{};  ///< of its box: greatest - least + 1, at most 512
};

struct Charts {
  static constexpr std::uint32_t kLoose = 0xFFFFFFFF;
  std::vector<Chart> charts;
  std::vector<std::uint32_t> chart_of;  ///< [cells] index in charts, or kLoose
};

/// (u, v): the coordinates but that along the axis, in ascending order.
constexpr std::array<std::int32_t, 2> project(const Voxel& v, std::uint8_t axis) {
  return {v[axis == 0 ? 1 : 0], v[axis == 2 ? 1 : 2]};
}

/// @param morton  of the cells of `grid`, of a cube of side 2^depth
/// @param axes    of the blocks
/// O(27 cells); 4 MiB and 8 bytes a cell besides what it returns.
Charts grow_charts(const BlockGrid& grid, std::span<const std::uint64_t> morton, int depth,
                   std::span<const std::uint8_t> axes);

}  // namespace slf
