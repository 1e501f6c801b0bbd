// SPDX-License-Identifier: Apache-2.0
// The pixel of every point of a slice, derived from the positions. Spec 8.11.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "slf/error.h"

namespace slf {

struct Atlas {
  std::int32_t width = 0, height = 0;  ///< multiples of 8, 64 .. 8192
  std::vector<std::uint32_t> pixel;    ///< [P] y * width + x; no two are equal
  std::size_t num_charts = 0;
  std::size_t num_loose = 0;  ///< points outside charts
};

inline constexpr int kMostCellLog2 = 7;

/// @param morton     distinct, ascending, at least one, at most 2^22, of a cube of side 2^depth
/// @param cell_log2  0 .. kMostCellLog2: a pixel of a chart is a cell of side 2^cell_log2, which
///                   should be the distance between points
/// @errors kLimitExceeded texture_size: higher than 8192.
/// One thread; the same result everywhere. O(P (27 + depth)) and O(charts * width / 4) for packing;
/// memory O(P), below that of the octree's neighbours. Source: spec 8.11.
Result<Atlas> derive_atlas(std::span<const std::uint64_t> morton, int depth, int cell_log2);

}  // namespace slf
