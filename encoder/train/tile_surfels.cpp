// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "base/multiversion.h"
#include "encoder/train/draw_surfels.h"
#include "encoder/train/surfel_projection.h"
#include "encoder/train/tile_pixels.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kPairGrain = 1024;  // surfels
constexpr int kDigitBits = 11;            // of a sort, by three

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

/// @param ends  [projected] receives where each one's pairs end
SLF_MULTIVERSION_ALL void find_pairs(const SurfelTiles& tiles, std::size_t begin, std::size_t end,
                                     std::vector<TilePair>& pairs,
                                     std::vector<std::uint32_t>& ends) {
  for (std::size_t i = begin; i < end; ++i) {
    const ProjectedSurfel& s = tiles.projected[i];
    const TileBox box = tiles_of(s, tiles.columns, tiles.rows);
    for (int y = box.top; y <= box.bottom; ++y)
      for (int x = box.left; x <= box.right; ++x)
        if (const BlockSet blocks = blocks_of(s, float(x * kTileSide), float(y * kTileSide)))
          pairs.push_back({std::uint32_t(y * tiles.columns + x), blocks});
    ends[i] = std::uint32_t(pairs.size());
  }
}

/// Tiles of each surfel, projected by projected.
std::vector<TilePair> all_pairs(SurfelTiles& tiles, int threads) {
  const std::size_t count = tiles.projected.size();
  std::vector<std::vector<TilePair>> parts((count + kPairGrain - 1) / kPairGrain);
  std::vector<std::uint32_t> ends(count);
  parallel_ranges(count, kPairGrain, threads, [&](std::size_t begin, std::size_t end) {
    find_pairs(tiles, begin, end, parts[begin / kPairGrain], ends);
  });
  std::vector<TilePair> pairs;
  tiles.pair_first.assign(count + 1, 0);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (std::size_t i = p * kPairGrain; i < std::min(count, (p + 1) * kPairGrain); ++i)
      tiles.pair_first[i + 1] = std::uint32_t(pairs.size()) + ends[i];
    pairs.insert(pairs.end(), parts[p].begin(), parts[p].end());
  }
  return pairs;
}

void bin(const std::vector<TilePair>& pairs, SurfelTiles& tiles) {
  const std::size_t count = std::size_t(tiles.columns) * std::size_t(tiles.rows);
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

/// Indices of those that are seen: nearest first, then by index.
std::vector<std::uint32_t> front_to_back(const std::vector<ProjectedSurfel>& all) {
  struct Key {
    std::uint32_t depth, index;
  };
  std::vector<Key> keys, next;
  for (std::size_t i = 0; i < all.size(); ++i)  // an inverse depth is above 0: its bits ascend
    if (all[i].opacity > 0)
      keys.push_back({~std::bit_cast<std::uint32_t>(all[i].near), std::uint32_t(i)});
  next.resize(keys.size());
  for (int digit = 0; digit < 32; digit += kDigitBits) {
    std::array<std::uint32_t, 1 << kDigitBits> place{};
    const auto digit_of = [digit](const Key& key) {
      return key.depth >> digit & ((1 << kDigitBits) - 1);
    };
    for (const Key& key : keys) ++place[digit_of(key)];
    std::exclusive_scan(place.begin(), place.end(), place.begin(), 0u);
    for (const Key& key : keys) next[place[digit_of(key)]++] = key;
    keys.swap(next);
  }
  std::vector<std::uint32_t> order(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) order[i] = keys[i].index;
  return order;
}

/// Projected surfels that any pixel shows, in the order of surfels, in which they lie in memory.
std::vector<std::uint32_t> drawn_by_surfel(const SurfelTiles& tiles,
                                           const std::vector<ProjectedGradient>& gradients,
                                           std::size_t surfels) {
  constexpr auto kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> order(surfels, kNone);
  for (std::size_t i = 0; i < gradients.size(); ++i)
    if (gradients[i].drawn > 0) order[tiles.projected[i].surfel] = std::uint32_t(i);
  std::erase(order, kNone);
  return order;
}

}  // namespace

SurfelTiles tile_surfels(const TrainedSurfels& surfels, const TrainingCamera& camera, int threads) {
  SurfelTiles tiles;
  tiles.columns = (camera.width + kTileSide - 1) / kTileSide;
  tiles.rows = (camera.height + kTileSide - 1) / kTileSide;
  std::vector<ProjectedSurfel> all(surfels.size());
  parallel_ranges(surfels.size(), 2048, threads, [&](std::size_t begin, std::size_t end) {
    project_trained(surfels, begin, end, camera, all);
  });
  const std::vector<std::uint32_t> order = front_to_back(all);
  tiles.projected.reserve(order.size());
  for (const std::uint32_t i : order) tiles.projected.push_back(all[i]);
  bin(all_pairs(tiles, threads), tiles);
  return tiles;
}

void set_surfel_gradients(const TrainedSurfels& surfels, const TrainingCamera& camera,
                          const SurfelTiles& tiles, const std::vector<ProjectedGradient>& projected,
                          std::vector<TrainedSurfel>& gradients, int threads) {
  const std::vector<std::uint32_t> drawn = drawn_by_surfel(tiles, projected, surfels.size());
  parallel_ranges(drawn.size(), 1024, threads, [&](std::size_t begin, std::size_t end) {
    set_trained_gradients(surfels, camera, tiles.projected, projected,
                          std::span(drawn).subspan(begin, end - begin), gradients);
  });
}

}  // namespace slf
