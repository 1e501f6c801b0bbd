// SPDX-License-Identifier: Apache-2.0
// Which splats touch which tile of the picture, and the picture of a tile.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lightfield/render/gaussian_cloud.h"
#include "slf/render.h"

namespace slf {

inline constexpr int kGaussianTile = 16;  // pixels; the sums of a tile stay in the nearest cache

/// For each tile, row by row, the splats whose ellipse within the reach touches it, ascending.
struct GaussianTiles {
  int columns = 0, rows = 0;
  std::vector<std::size_t> begin;  ///< [tiles + 1] into `splats`
  std::vector<std::uint32_t> splats;

  std::size_t size() const { return std::size_t(columns) * std::size_t(rows); }
  std::span<const std::uint32_t> of(std::size_t tile) const {
    return std::span(splats).subspan(begin[tile], begin[tile + 1] - begin[tile]);
  }
};

GaussianTiles bin_gaussians(const std::vector<ProjectedGaussian>& splats, int width, int height,
                            int threads);

/// Blends the splats of a tile, nearest first, over the background.
void blend_tile(const std::vector<ProjectedGaussian>& splats, const GaussianTiles& tiles,
                std::size_t tile, const std::array<std::uint8_t, 3>& background, Rendering& out);

}  // namespace slf
