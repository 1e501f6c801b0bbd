// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <bit>
#include <cstring>

#include "base/multiversion.h"
#include "encoder/train/draw_surfels.h"
#include "encoder/train/near_limits.h"
#include "encoder/train/tile_pixels.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::int32_t kMagnitude = 0x7fffffff;  // of a float: all but its sign

/// What one block of a tile has left, nearest surfels first.
struct BackwardBlock {
  Lanes transparency, remaining;  // remaining: sum over what follows of weight * worth
  Lanes red, green, blue;         // gradients by the picture
  Lanes hiding;                   // by the share of the background that is hidden
  Lanes total, near, near_square, pivot;
};

/// Sums over the pixels of a tile of what one surfel's gradient is made of.
struct SurfelSums {
  Lanes red, green, blue, drawn, pull;
  Lanes one, u, v, uu, uv, vv;  // moments of the gradient by r^2: of du, dv and their products
  Lanes near, near_u, near_v;   // of the gradient by the inverse depth
};

template <bool kGaussian>
[[gnu::always_inline]] inline void add_gradient(const ProjectedSurfel& s, float left, float top,
                                                std::size_t i, float spread, float most_near,
                                                BackwardBlock& block, SurfelSums& sums) {
  BlockSurfel p;
  set_place(s, left, top, i, block.transparency, p);
  set_alpha<kGaussian>(s, p);
  const Lanes weight = p.alpha * block.transparency;
  // What a change of the weight is worth.
  Lanes worth =
      s.colour[0] * block.red + s.colour[1] * block.green + s.colour[2] * block.blue + block.hiding;
  if constexpr (!kGaussian) {
    Lanes near = p.near - block.pivot;
    LaneMask within;
    limit_near(most_near, near, within);
    worth += spread * (block.near_square + near * (block.total * near - 2 * block.near));
    const Lanes pulled = spread * 2 * weight * (block.total * near - block.near);
    const Lanes by_near = within ? pulled : Lanes{};
    sums.near += by_near;
    sums.near_u += by_near * p.du;
    sums.near_v += by_near * p.dv;
  }
  block.remaining -= weight * worth;
  const Lanes by_alpha = block.transparency * worth - block.remaining / (1 - p.alpha);
  const Lanes by_kernel = p.alpha < kMostAlpha ? by_alpha : Lanes{};
  const Lanes by_square = kGaussian ? (-kGaussianReach / 2 * s.opacity) * by_kernel * p.kernel
                                    : (-4 * s.opacity) * by_kernel * p.inside * p.inside * p.inside;
  const Lanes by_u = by_square * p.du, by_v = by_square * p.dv;
  sums.red += weight * block.red;
  sums.green += weight * block.green;
  sums.blue += weight * block.blue;
  sums.drawn += weight;
  sums.one += by_square;
  sums.u += by_u;
  sums.v += by_v;
  sums.uu += by_u * p.du;
  sums.uv += by_u * p.dv;
  sums.vv += by_v * p.dv;
  const Lanes gu = s.a * by_u + s.b * by_v, gv = s.b * by_u + s.c * by_v;
  sums.pull += __builtin_bit_cast(Lanes, __builtin_bit_cast(LaneMask, gu) & kMagnitude) +
               __builtin_bit_cast(Lanes, __builtin_bit_cast(LaneMask, gv) & kMagnitude);
  block.transparency -= weight;
}

/// @param gaussian  its kernel, not that of a disc
[[gnu::always_inline]] inline void set_gradient(const SurfelSums& sums, const ProjectedSurfel& s,
                                                bool gaussian, ProjectedGradient& g) {
  Lanes eight;
  set_sums({sums.red, sums.green, sums.blue, sums.one, sums.u, sums.v, sums.uu, sums.uv}, eight);
  std::array<float, 8> m;
  std::memcpy(m.data(), &eight, sizeof eight);
  g.colour = {m[0], m[1], m[2]};
  const float one = m[3], u = m[4], v = m[5];
  g.a = m[6];
  g.b = 2 * m[7];
  set_sums({sums.vv, sums.drawn, sums.pull, sums.near, sums.near_u, sums.near_v, Lanes{}, Lanes{}},
           eight);
  std::memcpy(m.data(), &eight, sizeof eight);
  g.c = m[0];
  g.drawn = m[1];
  g.pull = m[2];
  g.near = m[3];
  g.near_du = m[4];
  g.near_dv = m[5];
  g.u = -2 * (s.a * u + s.b * v) - s.near_du * g.near;
  g.v = -2 * (s.b * u + s.c * v) - s.near_dv * g.near;
  // The gradient by r^2 is that by the kernel times the kernel's own: k times a factor, or
  // -4 (1 - r^2)^3, which is k over 1 - r^2.
  g.opacity = gaussian ? one * (-2 / (kGaussianReach * s.opacity))
                       : (one - (s.a * g.a + s.b * g.b + s.c * g.c)) / (-4 * s.opacity);
}

[[gnu::always_inline]] inline void load_backward(const DrawnSurfels& drawn,
                                                 const TrainingView& view,
                                                 const PlanarPicture& picture, const BlockPlace& at,
                                                 float spread, BackwardBlock& b) {
  Lanes transparency, red, green, blue;
  load_block(picture.plane(0), at, 0, b.red);
  load_block(picture.plane(1), at, 0, b.green);
  load_block(picture.plane(2), at, 0, b.blue);
  load_block(drawn.picture.plane(0), at, 0, red);
  load_block(drawn.picture.plane(1), at, 0, green);
  load_block(drawn.picture.plane(2), at, 0, blue);
  // The sum over all surfels and the background, since the picture has both.
  b.remaining = red * b.red + green * b.green + blue * b.blue;
  b.transparency = Lanes{} + 1.0f;
  load_block(drawn.transparency.data(), at, 1, transparency);
  b.hiding = Lanes{};
  if (!view.hiding.empty()) load_block(view.hiding.data(), at, 0, b.hiding);
  b.remaining += b.hiding * (1 - transparency);
  if (view.camera.gaussian) return;
  load_block(drawn.near.data(), at, 0, b.near);
  load_block(drawn.near_square.data(), at, 0, b.near_square);
  load_block(drawn.pivot.data(), at, 0, b.pivot);
  b.total = 1 - transparency;
  b.remaining += 2 * spread * (b.total * b.near_square - b.near * b.near);
}

SLF_MULTIVERSION_LANES void tile_gradients(const SurfelTiles& tiles, const TrainingView& view,
                                           const DrawnSurfels& drawn, const PlanarPicture& picture,
                                           float spread, std::size_t tile,
                                           std::vector<ProjectedGradient>& pairs) {
  const int x = int(tile) % tiles.columns * kTileSide, y = int(tile) / tiles.columns * kTileSide;
  if (tiles.first[tile] == tiles.first[tile + 1]) return;
  const float most_near = most_near_of(view.camera);
  const bool gaussian = view.camera.gaussian;
  std::array<BackwardBlock, kBlocksOfTile> blocks;
  for (std::size_t i = 0; i < kBlocksOfTile; ++i)
    load_backward(drawn, view, picture,
                  {x + kBlockColumns * int(i % kTileBlocks), y + kBlockRows * int(i / kTileBlocks),
                   view.camera.width, view.camera.height},
                  spread, blocks[i]);
  for (std::uint32_t k = tiles.first[tile]; k < tiles.first[tile + 1]; ++k) {
    const ProjectedSurfel& s = tiles.projected[tiles.list[k]];
    SurfelSums sums{};
    for (BlockSet rest = drawn.blocks[k]; rest != 0; rest &= rest - 1) {
      const auto i = std::size_t(std::countr_zero(rest));
      if (gaussian) {
        add_gradient<true>(s, float(x), float(y), i, spread, most_near, blocks[i], sums);
      } else {
        add_gradient<false>(s, float(x), float(y), i, spread, most_near, blocks[i], sums);
      }
    }
    set_gradient(sums, s, gaussian, pairs[tiles.pair[k]]);
  }
}

void add(const ProjectedGradient& from, ProjectedGradient& to) {
  using Values = std::array<float, sizeof(ProjectedGradient) / sizeof(float)>;
  auto sum = std::bit_cast<Values>(to);
  const auto more = std::bit_cast<Values>(from);
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += more[i];
  to = std::bit_cast<ProjectedGradient>(sum);
}

}  // namespace

void surfel_gradients(const SurfelTiles& tiles, const TrainingView& view, const DrawnSurfels& drawn,
                      const PlanarPicture& picture, float spread, int threads,
                      ProjectedGradients& gradients) {
  auto& [sums, pairs] = gradients;
  pairs.resize(tiles.list.size());
  parallel_ranges(tiles.first.size() - 1, 8, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      tile_gradients(tiles, view, drawn, picture, spread, t, gradients.pairs);
  });
  sums.assign(tiles.projected.size(), {});
  parallel_ranges(sums.size(), 2048, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::uint32_t p = tiles.pair_first[i]; p < tiles.pair_first[i + 1]; ++p)
        add(gradients.pairs[p], gradients.sums[i]);
  });
}

}  // namespace slf
