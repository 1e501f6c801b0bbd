// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/draw_surfels.h"

#include <array>
#include <bit>

#include "base/multiversion.h"
#include "encoder/train/near_limits.h"
#include "encoder/train/tile_pixels.h"
#include "slf/parallel.h"

namespace slf {
namespace {

/// Sums of a tile's pixels.
struct TileSums {
  std::array<Lanes, kBlocksOfTile> transparency, red, green, blue, near, near_square, pivot;
  BlockSet clear = ~BlockSet{0};  // blocks where more may be seen
};

/// @return whether block i shows it
template <bool kGaussian>
[[gnu::always_inline]] inline bool add_to_block(const ProjectedSurfel& s, float left, float top,
                                                float most_near, std::size_t i, TileSums& sums) {
  Lanes& transparency = sums.transparency[i];
  BlockSurfel b;
  if (!set_block_surfel<kGaussian>(s, left, top, i, transparency, b)) return false;
  const Lanes weight = b.alpha * transparency;
  sums.red[i] += weight * s.colour[0];
  sums.green[i] += weight * s.colour[1];
  sums.blue[i] += weight * s.colour[2];
  if constexpr (!kGaussian) {
    const LaneMask first = b.shows & (transparency == 1.0f);
    sums.pivot[i] = first ? b.near : sums.pivot[i];
    Lanes near = b.near - sums.pivot[i];
    LaneMask within;
    limit_near(most_near, near, within);
    const Lanes weighted = weight * near;
    sums.near[i] += weighted;
    sums.near_square[i] += weighted * near;
  }
  transparency -= weight;
  return true;
}

/// @return the blocks that show it
template <bool kGaussian>
[[gnu::always_inline]] inline BlockSet add_surfel(const ProjectedSurfel& s, BlockSet blocks,
                                                  float left, float top, float most_near,
                                                  TileSums& sums) {
  BlockSet shown = blocks & sums.clear;
  for (BlockSet rest = shown; rest != 0; rest &= rest - 1) {
    const auto i = std::size_t(std::countr_zero(rest));
    if (add_to_block<kGaussian>(s, left, top, most_near, i, sums)) continue;
    const BlockSet bit = BlockSet{1} << i;
    shown &= ~bit;
    if (!any(sums.transparency[i] > kLeastTransparency)) sums.clear &= ~bit;
  }
  return shown;
}

void store_tile(const TileSums& sums, int x, int y, const TrainingView& view, DrawnSurfels& drawn) {
  for (std::size_t i = 0; i < kBlocksOfTile; ++i) {
    const BlockPlace at{x + kBlockColumns * int(i % kTileBlocks),
                        y + kBlockRows * int(i / kTileBlocks), view.camera.width,
                        view.camera.height};
    const Lanes& t = sums.transparency[i];
    store_block(sums.red[i] + t * view.background[0], at, drawn.picture.plane(0));
    store_block(sums.green[i] + t * view.background[1], at, drawn.picture.plane(1));
    store_block(sums.blue[i] + t * view.background[2], at, drawn.picture.plane(2));
    store_block(t, at, drawn.transparency.data());
    if (view.camera.gaussian) continue;
    store_block(sums.near[i], at, drawn.near.data());
    store_block(sums.near_square[i], at, drawn.near_square.data());
    store_block(sums.pivot[i], at, drawn.pivot.data());
  }
}

SLF_MULTIVERSION_LANES void draw_tile(const SurfelTiles& tiles, const TrainingView& view,
                                      std::size_t tile, DrawnSurfels& drawn) {
  const int x = int(tile) % tiles.columns * kTileSide, y = int(tile) / tiles.columns * kTileSide;
  const float most_near = most_near_of(view.camera);
  TileSums sums{};
  for (Lanes& t : sums.transparency) t += 1.0f;
  for (std::uint32_t k = tiles.first[tile]; k < tiles.first[tile + 1]; ++k) {
    const ProjectedSurfel& s = tiles.projected[tiles.list[k]];
    drawn.blocks[k] =
        view.camera.gaussian
            ? add_surfel<true>(s, tiles.blocks[k], float(x), float(y), most_near, sums)
            : add_surfel<false>(s, tiles.blocks[k], float(x), float(y), most_near, sums);
  }
  store_tile(sums, x, y, view, drawn);
}

std::size_t tile_count(const SurfelTiles& tiles) { return tiles.first.size() - 1; }

}  // namespace

void draw_surfels(const SurfelTiles& tiles, const TrainingView& view, int threads,
                  DrawnSurfels& drawn) {
  drawn.picture.width = view.camera.width;
  drawn.picture.height = view.camera.height;
  const std::size_t pixels = drawn.picture.pixels();
  drawn.picture.value.resize(3 * pixels);
  for (auto* plane : {&drawn.transparency, &drawn.near, &drawn.near_square, &drawn.pivot})
    plane->resize(pixels);
  drawn.blocks.resize(tiles.list.size());
  parallel_ranges(tile_count(tiles), 8, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) draw_tile(tiles, view, t, drawn);
  });
}

}  // namespace slf
