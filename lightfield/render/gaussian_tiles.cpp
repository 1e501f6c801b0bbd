// SPDX-License-Identifier: Apache-2.0
#include "lightfield/render/gaussian_tiles.h"

#include <algorithm>
#include <cmath>

#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kSpansPerRange = 4096;

/// Tiles of a row that a splat touches.
struct TileSpan {
  std::uint32_t splat;
  std::uint16_t row, first, last;
};

/// Farthest that an ellipse goes to the right between two rows, from its centre. To the left: of
/// the mirrored ellipse, -b.
float rightmost(const ProjectedGaussian& s, float b, float top, float bottom) {
  // The rightmost point of all is where the derivative along the rows is 0: y = -b x / c.
  const float y = std::clamp(-b / s.c * s.half_width, top, bottom);
  const float root = std::max(0.0f, b * b * y * y - s.a * (s.c * y * y - s.reach));
  return (std::sqrt(root) - b * y) / s.a;
}

/// The tile of a coordinate, one of 0 .. tiles - 1.
int tile_of(float pixels, int tiles) {
  return static_cast<int>(std::clamp(std::floor(pixels / kGaussianTile), 0.0f, float(tiles - 1)));
}

/// Pixel centres decide: a tile's first is half a pixel from its edge.
void append_spans(const ProjectedGaussian& s, std::uint32_t index, const GaussianTiles& tiles,
                  std::vector<TileSpan>& out) {
  const int top = tile_of(s.v - s.half_height, tiles.rows);
  const int bottom = tile_of(s.v + s.half_height, tiles.rows);
  for (int row = top; row <= bottom; ++row) {
    const float above = float(row * kGaussianTile) - s.v, below = above + kGaussianTile;
    const float right = s.u + rightmost(s, s.b, above, below);
    const float left = s.u - rightmost(s, -s.b, above, below);
    if (!(right >= 0 && left <= float(tiles.columns * kGaussianTile))) continue;  // or NaN
    out.push_back({index, static_cast<std::uint16_t>(row),
                   static_cast<std::uint16_t>(tile_of(left, tiles.columns)),
                   static_cast<std::uint16_t>(tile_of(right, tiles.columns))});
  }
}

}  // namespace

GaussianTiles bin_gaussians(const std::vector<ProjectedGaussian>& splats, int width, int height,
                            int threads) {
  GaussianTiles tiles;
  tiles.columns = (width + kGaussianTile - 1) / kGaussianTile;
  tiles.rows = (height + kGaussianTile - 1) / kGaussianTile;
  std::vector<std::vector<TileSpan>> spans((splats.size() + kSpansPerRange - 1) / kSpansPerRange);
  parallel_ranges(splats.size(), kSpansPerRange, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      append_spans(splats[i], static_cast<std::uint32_t>(i), tiles, spans[begin / kSpansPerRange]);
  });
  tiles.begin.assign(tiles.size() + 1, 0);
  const auto for_each_tile = [&](auto&& visit) {
    for (const auto& part : spans)
      for (const TileSpan& span : part)
        for (std::size_t column = span.first; column <= span.last; ++column)
          visit(span.row * std::size_t(tiles.columns) + column, span.splat);
  };
  for_each_tile([&](std::size_t tile, std::uint32_t) { ++tiles.begin[tile + 1]; });
  for (std::size_t i = 1; i < tiles.begin.size(); ++i) tiles.begin[i] += tiles.begin[i - 1];
  tiles.splats.resize(tiles.begin.back());
  std::vector<std::size_t> next(tiles.begin.begin(), tiles.begin.end() - 1);
  for_each_tile([&](std::size_t tile, std::uint32_t splat) { tiles.splats[next[tile]++] = splat; });
  return tiles;
}

}  // namespace slf
