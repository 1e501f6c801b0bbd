// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "base/multiversion.h"
#include "encoder/train/draw_surfels.h"
#include "encoder/train/surfel_projection.h"
#include "encoder/train/tile_pixels.h"
#include "slf/parallel.h"

namespace slf {
namespace {

struct TileBox {
  int left, right, top, bottom;  // inclusive; none where right < left
};

/// Tiles with a pixel centre in the ellipse's box.
TileBox tiles_of(const ProjectedSurfel& s, int columns, int rows) {
  // An ellipse near the camera may be wider than an int says.
  const auto tile = [](float x) { return int(std::floor(std::min(x, 1e6f))) / kTileSide; };
  return {tile(std::max(s.u - s.half_width, 0.0f)),
          std::min(tile(std::max(s.u + s.half_width, 0.0f)), columns - 1),
          tile(std::max(s.v - s.half_height, 0.0f)),
          std::min(tile(std::max(s.v + s.half_height, 0.0f)), rows - 1)};
}

/// Places of a surfel: a tile that shows it, and the blocks there.
struct TilePair {
  std::uint32_t tile;
  BlockSet blocks;
};

/// Tiles of each surfel, projected by projected.
SLF_MULTIVERSION_ALL void find_pairs(SurfelTiles& tiles, std::vector<TilePair>& pairs) {
  for (std::size_t i = 0; i < tiles.projected.size(); ++i) {
    const ProjectedSurfel& s = tiles.projected[i];
    const TileBox box = tiles_of(s, tiles.columns, tiles.rows);
    for (int y = box.top; y <= box.bottom; ++y)
      for (int x = box.left; x <= box.right; ++x)
        if (const BlockSet blocks = blocks_of(s, float(x * kTileSide), float(y * kTileSide)))
          pairs.push_back({std::uint32_t(y * tiles.columns + x), blocks});
    tiles.pair_first[i + 1] = std::uint32_t(pairs.size());
  }
}

void bin(SurfelTiles& tiles) {
  const std::size_t count = std::size_t(tiles.columns) * std::size_t(tiles.rows);
  std::vector<TilePair> pairs;
  tiles.pair_first.assign(tiles.projected.size() + 1, 0);
  find_pairs(tiles, pairs);
  tiles.first.assign(count + 1, 0);
  for (const TilePair& pair : pairs) ++tiles.first[pair.tile + 1];
  for (std::size_t t = 0; t < count; ++t) tiles.first[t + 1] += tiles.first[t];
  tiles.list.resize(pairs.size());
  tiles.blocks.resize(pairs.size());
  tiles.pair.resize(pairs.size());
  std::vector<std::uint32_t> next(tiles.first.begin(), tiles.first.end() - 1);
  for (std::size_t i = 0; i < tiles.projected.size(); ++i)
    for (std::uint32_t p = tiles.pair_first[i]; p < tiles.pair_first[i + 1]; ++p) {
      const std::uint32_t place = next[pairs[p].tile]++;
      tiles.pair[place] = p;
      tiles.list[place] = std::uint32_t(i);
      tiles.blocks[place] = pairs[p].blocks;
    }
}

}  // namespace

SurfelTiles tile_surfels(const TrainedSurfels& surfels, const TrainingCamera& camera, int threads) {
  SurfelTiles tiles;
  tiles.columns = (camera.width + kTileSide - 1) / kTileSide;
  tiles.rows = (camera.height + kTileSide - 1) / kTileSide;
  std::vector<ProjectedSurfel> all(surfels.size());
  parallel_ranges(surfels.size(), 2048, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (const auto p = project_surfel(surfels[i], camera)) all[i] = p->projected;
      all[i].surfel = std::uint32_t(i);
    }
  });
  std::vector<std::pair<float, std::uint32_t>> order;  // farther: less inverse depth
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].opacity > 0) order.emplace_back(-all[i].near, std::uint32_t(i));
  std::sort(order.begin(), order.end());
  tiles.projected.reserve(order.size());
  for (const auto& [near, i] : order) tiles.projected.push_back(all[i]);
  bin(tiles);
  return tiles;
}

void add_surfel_gradients(const TrainedSurfels& surfels, const TrainingCamera& camera,
                          const SurfelTiles& tiles, const std::vector<ProjectedGradient>& projected,
                          std::vector<TrainedSurfel>& gradients, int threads) {
  parallel_ranges(projected.size(), 1024, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t surfel = tiles.projected[i].surfel;
      if (!(projected[i].drawn > 0)) continue;
      if (const auto p = project_surfel(surfels[surfel], camera))
        add_projection_gradient(surfels[surfel], camera, *p, projected[i], gradients[surfel]);
    }
  });
}

}  // namespace slf
