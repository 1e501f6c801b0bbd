// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "base/multiversion.h"
#include "encoder/train/draw_surfels.h"
#include "encoder/train/tile_pixels.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr float kOpaque = 0.5f;  // transparency: where a pixel's depth is

SLF_MULTIVERSION_ALL void find_depths(const SurfelTiles& tiles, const TrainingCamera& camera,
                                      std::size_t tile, SurfelDepths& depths) {
  const int x = int(tile) % tiles.columns * kTileSide, y = int(tile) / tiles.columns * kTileSide;
  std::array<Lanes, kBlocksOfTile> transparency{};
  for (Lanes& t : transparency) t += 1.0f;
  for (std::uint32_t k = tiles.first[tile]; k < tiles.first[tile + 1]; ++k) {
    const ProjectedSurfel& s = tiles.projected[tiles.list[k]];
    for (BlockSet rest = tiles.blocks[k]; rest != 0; rest &= rest - 1) {
      const auto block = std::size_t(std::countr_zero(rest));
      Lanes& t = transparency[block];
      const int left = x + kBlockColumns * int(block % kTileBlocks);
      const int top = y + kBlockRows * int(block / kTileBlocks);
      BlockSurfel b;
      const bool shows = camera.gaussian
                             ? set_block_surfel<true>(s, float(x), float(y), block, t, b)
                             : set_block_surfel<false>(s, float(x), float(y), block, t, b);
      if (!shows) continue;
      const Lanes after = t - b.alpha * t;
      const LaneMask here = (t >= kOpaque) & (after < kOpaque);
      t = after;
      if (!any(here)) continue;
      for (int i = 0; i < 8; ++i) {
        const int u = left + i % kBlockColumns, v = top + i / kBlockColumns;
        if (here[i] == 0 || u >= camera.width || v >= camera.height) continue;
        if (!(b.near[i] > 0)) continue;
        const std::size_t pixel = std::size_t(v) * std::size_t(camera.width) + std::size_t(u);
        depths.depth[pixel] = camera.depth / b.near[i];
        depths.surfel[pixel] = s.surfel;
      }
    }
  }
}

}  // namespace

SurfelDepths surfel_depths(const SurfelTiles& tiles, const TrainingCamera& camera, int threads) {
  SurfelDepths depths;
  const std::size_t pixels = std::size_t(camera.width) * std::size_t(camera.height);
  depths.depth.assign(pixels, 0);
  depths.surfel.assign(pixels, 0);
  parallel_ranges(tiles.first.size() - 1, 8, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) find_depths(tiles, camera, t, depths);
  });
  return depths;
}

}  // namespace slf
