// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/draw_surfels.h"

#include <algorithm>

#include "base/multiversion.h"
#include "encoder/train/tile_pixels.h"
#include "slf/parallel.h"

namespace slf {
namespace {

/// What lies farther apart than this in depth, pixels, is no farther apart: one surfel far behind
/// would outweigh all that is right.
constexpr float kMostApart = 8;

float most_near_of(const TrainingCamera& camera) {
  return kMostApart / std::max(camera.fx, camera.fy);
}

/// @param within  receives where it was within the limits
[[gnu::always_inline]] inline void limit_near(float most, Lanes& near, LaneMask& within) {
  within = (near < most) & (near > -most);
  near = near < most ? near : Lanes{} + most;
  near = near > -most ? near : Lanes{} - most;
}

/// Sums of a tile's pixels.
struct TileSums {
  std::array<Lanes, kBlocksOfTile> transparency, red, green, blue, near, near_square, pivot;
};

template <bool kGaussian>
[[gnu::always_inline]] inline void add_surfel(const ProjectedSurfel& s, float left, float top,
                                              float most_near, TileSums& sums) {
  const BlockBox box = blocks_of(s, left, top);
  for (int row = box.top; row <= box.bottom; ++row)
    for (int column = box.left; column <= box.right; ++column) {
      const auto i = std::size_t(kTileBlocks * row + column);
      Lanes& transparency = sums.transparency[i];
      BlockSurfel b;
      if (!set_block_surfel<kGaussian>(s, left + float(kBlockColumns * column),
                                       top + float(kBlockRows * row), transparency, b))
        continue;
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
    }
}

SLF_MULTIVERSION_ALL void draw_tile(const SurfelTiles& tiles, const TrainingView& view,
                                    std::size_t tile, DrawnSurfels& drawn) {
  const int x = int(tile) % tiles.columns * kTileSide, y = int(tile) / tiles.columns * kTileSide;
  const float most_near = most_near_of(view.camera);
  TileSums sums{};
  for (Lanes& t : sums.transparency) t += 1.0f;
  for (std::uint32_t k = tiles.first[tile]; k < tiles.first[tile + 1]; ++k) {
    const ProjectedSurfel& s = tiles.projected[tiles.list[k]];
    if (view.camera.gaussian) {
      add_surfel<true>(s, float(x), float(y), most_near, sums);
    } else {
      add_surfel<false>(s, float(x), float(y), most_near, sums);
    }
  }
  for (std::size_t i = 0; i < kBlocksOfTile; ++i) {
    const BlockPlace at{x + kBlockColumns * int(i % kTileBlocks),
                        y + kBlockRows * int(i / kTileBlocks), view.camera.width,
                        view.camera.height};
    const Lanes& t = sums.transparency[i];
    store_block(sums.red[i] + t * view.background[0], at, drawn.picture.plane(0));
    store_block(sums.green[i] + t * view.background[1], at, drawn.picture.plane(1));
    store_block(sums.blue[i] + t * view.background[2], at, drawn.picture.plane(2));
    store_block(t, at, drawn.transparency.data());
    store_block(sums.near[i], at, drawn.near.data());
    store_block(sums.near_square[i], at, drawn.near_square.data());
    store_block(sums.pivot[i], at, drawn.pivot.data());
  }
}

/// What one block of a tile has left, nearest surfels first.
struct BackwardBlock {
  Lanes transparency, remaining;  // remaining: sum over what follows of weight * worth
  Lanes red, green, blue;         // gradients by the picture
  Lanes total, near, near_square, pivot;
};

/// Sums over the pixels of a tile of what one surfel's gradient is made of.
struct SurfelSums {
  Lanes red, green, blue, opacity, a, b, c, u, v, near, near_du, near_dv, drawn, pull;
};

template <bool kGaussian>
[[gnu::always_inline]] inline void add_gradient(const ProjectedSurfel& s, float x, float y,
                                                float spread, float most_near, BackwardBlock& block,
                                                SurfelSums& sums) {
  BlockSurfel p;
  if (!set_block_surfel<kGaussian>(s, x, y, block.transparency, p)) return;
  const Lanes weight = p.alpha * block.transparency;
  // What a change of the weight is worth.
  Lanes worth = s.colour[0] * block.red + s.colour[1] * block.green + s.colour[2] * block.blue;
  Lanes by_near{};
  if constexpr (!kGaussian) {
    Lanes near = p.near - block.pivot;
    LaneMask within;
    limit_near(most_near, near, within);
    worth += spread * (block.near_square + near * (block.total * near - 2 * block.near));
    const Lanes pulled = spread * 2 * weight * (block.total * near - block.near);
    by_near = within ? pulled : by_near;
  }
  block.remaining -= weight * worth;
  const Lanes by_alpha = block.transparency * worth - block.remaining / (1 - p.alpha);
  const LaneMask free = p.shows & (p.alpha < kMostAlpha);
  const Lanes by_kernel = free ? by_alpha : Lanes{};
  const Lanes by_square = kGaussian ? (-kGaussianReach / 2 * s.opacity) * by_kernel * p.kernel
                                    : (-4 * s.opacity) * by_kernel * p.inside * p.inside * p.inside;
  const Lanes gu = s.a * p.du + s.b * p.dv, gv = s.b * p.du + s.c * p.dv;
  Lanes by_u = -2 * by_square * gu, by_v = -2 * by_square * gv;
  if constexpr (!kGaussian) {
    by_u -= s.near_du * by_near;
    by_v -= s.near_dv * by_near;
    sums.near += by_near;
    sums.near_du += by_near * p.du;
    sums.near_dv += by_near * p.dv;
  }
  sums.red += weight * block.red;
  sums.green += weight * block.green;
  sums.blue += weight * block.blue;
  sums.opacity += by_kernel * p.kernel;
  sums.a += by_square * p.du * p.du;
  sums.b += 2 * by_square * p.du * p.dv;
  sums.c += by_square * p.dv * p.dv;
  sums.u += by_u;
  sums.v += by_v;
  sums.drawn += weight;
  const Lanes square = by_square < 0 ? -by_square : by_square;
  const Lanes mu = gu < 0 ? -gu : gu, mv = gv < 0 ? -gv : gv;
  sums.pull += square * (mu + mv);
  block.transparency -= weight;
}

ProjectedGradient gradient_of(const SurfelSums& s) {
  return {{sum_of(s.red), sum_of(s.green), sum_of(s.blue)},
          sum_of(s.opacity),
          sum_of(s.a),
          sum_of(s.b),
          sum_of(s.c),
          sum_of(s.u),
          sum_of(s.v),
          sum_of(s.near),
          sum_of(s.near_du),
          sum_of(s.near_dv),
          sum_of(s.drawn),
          sum_of(s.pull)};
}

[[gnu::always_inline]] inline void load_backward(const DrawnSurfels& drawn,
                                                 const PlanarPicture& picture, const BlockPlace& at,
                                                 float spread, BackwardBlock& b) {
  Lanes transparency, red, green, blue;
  load_block(drawn.transparency.data(), at, 1, transparency);
  load_block(picture.plane(0), at, 0, b.red);
  load_block(picture.plane(1), at, 0, b.green);
  load_block(picture.plane(2), at, 0, b.blue);
  load_block(drawn.picture.plane(0), at, 0, red);
  load_block(drawn.picture.plane(1), at, 0, green);
  load_block(drawn.picture.plane(2), at, 0, blue);
  load_block(drawn.near.data(), at, 0, b.near);
  load_block(drawn.near_square.data(), at, 0, b.near_square);
  load_block(drawn.pivot.data(), at, 0, b.pivot);
  b.total = 1 - transparency;
  // The sum over all surfels and the background, since the picture has both.
  b.remaining = red * b.red + green * b.green + blue * b.blue +
                2 * spread * (b.total * b.near_square - b.near * b.near);
  b.transparency = Lanes{} + 1.0f;
}

SLF_MULTIVERSION_ALL void tile_gradients(const SurfelTiles& tiles, const TrainingView& view,
                                         const DrawnSurfels& drawn, const PlanarPicture& picture,
                                         float spread, std::size_t tile,
                                         std::vector<ProjectedGradient>& pairs) {
  const int x = int(tile) % tiles.columns * kTileSide, y = int(tile) / tiles.columns * kTileSide;
  if (tiles.first[tile] == tiles.first[tile + 1]) return;
  const float most_near = most_near_of(view.camera);
  std::array<BackwardBlock, kBlocksOfTile> blocks;
  for (std::size_t i = 0; i < kBlocksOfTile; ++i)
    load_backward(drawn, picture,
                  {x + kBlockColumns * int(i % kTileBlocks), y + kBlockRows * int(i / kTileBlocks),
                   view.camera.width, view.camera.height},
                  spread, blocks[i]);
  for (std::uint32_t k = tiles.first[tile]; k < tiles.first[tile + 1]; ++k) {
    const ProjectedSurfel& s = tiles.projected[tiles.list[k]];
    const BlockBox box = blocks_of(s, float(x), float(y));
    SurfelSums sums{};
    for (int row = box.top; row <= box.bottom; ++row)
      for (int column = box.left; column <= box.right; ++column) {
        BackwardBlock& block = blocks[std::size_t(kTileBlocks * row + column)];
        const auto u = float(x + kBlockColumns * column), v = float(y + kBlockRows * row);
        if (view.camera.gaussian) {
          add_gradient<true>(s, u, v, spread, most_near, block, sums);
        } else {
          add_gradient<false>(s, u, v, spread, most_near, block, sums);
        }
      }
    pairs[k] = gradient_of(sums);
  }
}

void add(const ProjectedGradient& from, ProjectedGradient& to) {
  for (std::size_t c = 0; c < 3; ++c) to.colour[c] += from.colour[c];
  to.opacity += from.opacity;
  to.a += from.a;
  to.b += from.b;
  to.c += from.c;
  to.u += from.u;
  to.v += from.v;
  to.near += from.near;
  to.near_du += from.near_du;
  to.near_dv += from.near_dv;
  to.drawn += from.drawn;
  to.pull += from.pull;
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
  parallel_ranges(tile_count(tiles), 8, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) draw_tile(tiles, view, t, drawn);
  });
}

std::vector<ProjectedGradient> surfel_gradients(const SurfelTiles& tiles, const TrainingView& view,
                                                const DrawnSurfels& drawn,
                                                const PlanarPicture& picture, float spread,
                                                int threads) {
  std::vector<ProjectedGradient> pairs(tiles.list.size());
  parallel_ranges(tile_count(tiles), 8, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      tile_gradients(tiles, view, drawn, picture, spread, t, pairs);
  });
  std::vector<ProjectedGradient> sums(tiles.projected.size());
  parallel_ranges(sums.size(), 2048, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::uint32_t k = tiles.pair_first[i]; k < tiles.pair_first[i + 1]; ++k)
        add(pairs[tiles.pair[k]], sums[i]);
  });
  return sums;
}

}  // namespace slf
