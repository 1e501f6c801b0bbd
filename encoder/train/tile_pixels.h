// SPDX-License-Identifier: Apache-2.0
// Pixels of a tile, eight at a time, as lightfield/render/lanes.h has them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "encoder/train/draw_surfels.h"
#include "lightfield/render/gaussian_cloud.h"
#include "lightfield/render/lanes.h"

namespace slf {

inline constexpr int kTileSide = 16, kBlockColumns = 4, kBlockRows = 2;
inline constexpr int kTileBlocks = kTileSide / kBlockColumns;  // in a row
inline constexpr std::size_t kBlocksOfTile = std::size_t(kTileBlocks * (kTileSide / kBlockRows));

/// Squared deviations at which a Gaussian of opacity 1 is 1/255: there a radius ends.
inline constexpr float kGaussianReach = 11.0825f;  // 2 ln 255
static_assert(GaussianKernel::least_alpha == 1.0f / 255);

inline constexpr float kMostAlpha = GaussianKernel::most_alpha;  // what is behind can be told
inline constexpr float kLeastTransparency = 1.0f / 512;          // less shows nothing

/// Blocks of a tile: bit kTileBlocks * row + column.
using BlockSet = std::uint32_t;
static_assert(kBlocksOfTile == 32 && kTileSide / kBlockRows == 8);

/// 0 .. kTileSide, of a number that may be none.
[[gnu::always_inline]] inline void limit_to_tile(Lanes& x) {
  x = x > 0.0f ? x : Lanes{};
  x = x < float(kTileSide) ? x : Lanes{} + float(kTileSide);
}

/// Adds the blocks with a pixel centre in the ellipse, of a row of pixels in each row of blocks.
/// @param v  the rows' centres, from the tile's first pixel
/// @param columns  [row of blocks] receives bits of blocks
[[gnu::always_inline]] inline void add_columns(const ProjectedSurfel& s, float u, const Lanes& dv,
                                               LaneMask& columns) {
  constexpr float kSlack = 1.0f / 64;  // pixels: a pixel's own test has other roundings
  const Lanes share = 1 - dv * dv * (1 / (s.half_height * s.half_height));
  Lanes half;
  set_root((share > 0.0f ? share : Lanes{}) * (s.reach / s.a), half);
  const Lanes middle = u - (s.b / s.a) * dv;
  Lanes begin = middle - half + (1 - kSlack), end = middle + half + (1 + kSlack);
  limit_to_tile(begin);
  limit_to_tile(end);
  const LaneMask first = __builtin_convertvector(begin, LaneMask);
  const LaneMask last = __builtin_convertvector(end, LaneMask);
  const LaneMask all = LaneMask{} + ((1 << kTileBlocks) - 1);
  const LaneMask from = all << (first / kBlockColumns);
  const LaneMask to = all << ((last + (kBlockColumns - 1)) / kBlockColumns);
  columns |= (share > -kSlack) & (last > first) & from & ~to & all;
}

/// Blocks of the tile at (left, top) that a surfel may touch: no fewer than it does.
[[gnu::always_inline]] inline BlockSet blocks_of(const ProjectedSurfel& s, float left, float top) {
  constexpr Lanes kFirstRows{0, 2, 4, 6, 8, 10, 12, 14};
  constexpr LaneMask kShifts{0, 4, 8, 12, 16, 20, 24, 28};
  const float u = s.u - left - 0.5f, v = s.v - top - 0.5f;  // a pixel's centre is at its index
  LaneMask columns{};
  add_columns(s, u, kFirstRows - v, columns);
  add_columns(s, u, kFirstRows + (1 - v), columns);
  columns <<= kShifts;
  std::array<std::uint32_t, 8> row;
  std::memcpy(row.data(), &columns, sizeof columns);
  return ((row[0] | row[4]) | (row[1] | row[5])) | ((row[2] | row[6]) | (row[3] | row[7]));
}

/// Sums of each vector's lanes, in the vectors' order.
[[gnu::always_inline]] inline void set_sums(const std::array<Lanes, 8>& v, Lanes& sums) {
  std::array<Lanes, 4> halves;  // of v[i] and of v[i + 4], four lanes each
  for (std::size_t i = 0; i < 4; ++i)
    halves[i] = __builtin_shufflevector(v[i], v[i + 4], 0, 1, 2, 3, 8, 9, 10, 11) +
                __builtin_shufflevector(v[i], v[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  std::array<Lanes, 2> pairs;
  for (std::size_t i = 0; i < 2; ++i)
    pairs[i] =
        __builtin_shufflevector(halves[2 * i], halves[2 * i + 1], 0, 1, 8, 9, 4, 5, 12, 13) +
        __builtin_shufflevector(halves[2 * i], halves[2 * i + 1], 2, 3, 10, 11, 6, 7, 14, 15);
  sums = __builtin_shufflevector(pairs[0], pairs[1], 0, 2, 8, 10, 4, 6, 12, 14) +
         __builtin_shufflevector(pairs[0], pairs[1], 1, 3, 9, 11, 5, 7, 13, 15);
}

/// Pixels of a block to and from a picture's plane; those outside are left out, or `outside`.
struct BlockPlace {
  int x, y, width, height;
};
[[gnu::always_inline]] inline bool is_whole(const BlockPlace& at) {
  return at.x + kBlockColumns <= at.width && at.y + kBlockRows <= at.height;
}
[[gnu::always_inline]] inline std::size_t pixel_of(const BlockPlace& at, int row) {
  return std::size_t(at.y + row) * std::size_t(at.width) + std::size_t(at.x);
}
[[gnu::always_inline]] inline void store_block(const Lanes& lanes, const BlockPlace& at,
                                               float* plane) {
  std::array<float, 8> v;
  std::memcpy(v.data(), &lanes, sizeof lanes);
  if (is_whole(at)) {
    for (int r = 0; r < kBlockRows; ++r)
      std::memcpy(plane + pixel_of(at, r), &v[std::size_t(kBlockColumns * r)],
                  kBlockColumns * sizeof(float));
    return;
  }
  for (int r = 0; r < kBlockRows && at.y + r < at.height; ++r)
    for (int k = 0; k < kBlockColumns && at.x + k < at.width; ++k)
      plane[pixel_of(at, r) + std::size_t(k)] = v[std::size_t(kBlockColumns * r + k)];
}
[[gnu::always_inline]] inline void load_block(const float* plane, const BlockPlace& at,
                                              float outside, Lanes& lanes) {
  std::array<float, 8> v;
  if (is_whole(at)) {
    for (int r = 0; r < kBlockRows; ++r)
      std::memcpy(&v[std::size_t(kBlockColumns * r)], plane + pixel_of(at, r),
                  kBlockColumns * sizeof(float));
    std::memcpy(&lanes, v.data(), sizeof lanes);
    return;
  }
  v.fill(outside);
  for (int r = 0; r < kBlockRows && at.y + r < at.height; ++r)
    for (int k = 0; k < kBlockColumns && at.x + k < at.width; ++k)
      v[std::size_t(kBlockColumns * r + k)] = plane[pixel_of(at, r) + std::size_t(k)];
  std::memcpy(&lanes, v.data(), sizeof lanes);
}

/// Pixels of a column of blocks, of a row of blocks, from the tile's corner.
inline constexpr std::array<Lanes, kTileBlocks> kBlockU = {kColumns, kColumns + 4.0f,
                                                           kColumns + 8.0f, kColumns + 12.0f};
inline constexpr std::array<Lanes, 8> kBlockV = {kRows,         kRows + 2.0f, kRows + 4.0f,
                                                 kRows + 6.0f,  kRows + 8.0f, kRows + 10.0f,
                                                 kRows + 12.0f, kRows + 14.0f};

/// A surfel in the pixels of a block.
struct BlockSurfel {
  Lanes du, dv, square, inside, kernel, alpha, near;  // square: r^2
  LaneMask shows;
};
/// exp(-reach r2 / 2) for r2 of 0 .. 1: within 2 % of itself where it is least, 0.02 % at one
/// deviation.
[[gnu::always_inline]] inline void set_gaussian(const Lanes& r2, Lanes& k) {
  const Lanes x = r2 * (-kGaussianReach / 2 / 32);
  k = 1 + x * (1 + 0.5f * x);
  for (int i = 0; i < 5; ++i) k = k * k;
}

/// Where the surfel is from a block's pixels, and which of them show it.
/// @param left, top  pixel of the tile's corner
[[gnu::always_inline]] inline void set_place(const ProjectedSurfel& s, float left, float top,
                                             std::size_t block, const Lanes& transparency,
                                             BlockSurfel& b) {
  b.du = (left + 0.5f - s.u) + kBlockU[block % kTileBlocks];
  b.dv = (top + 0.5f - s.v) + kBlockV[block / kTileBlocks];
  b.square = b.du * (s.a * b.du + 2 * s.b * b.dv) + s.c * b.dv * b.dv;
  b.shows = (b.square < s.reach) & (transparency > kLeastTransparency);
}

/// What they show of it: 0 where they do not.
template <bool kGaussian>
[[gnu::always_inline]] inline void set_alpha(const ProjectedSurfel& s, BlockSurfel& b) {
  b.inside = b.shows ? 1 - b.square : Lanes{};
  const Lanes square = b.inside * b.inside;
  if constexpr (kGaussian) {
    set_gaussian(b.square, b.kernel);
    b.kernel = b.shows ? b.kernel : Lanes{};
  } else {
    b.kernel = square * square;
  }
  const Lanes alpha = s.opacity * b.kernel;
  b.alpha = alpha < kMostAlpha ? alpha : Lanes{} + kMostAlpha;
  b.near = s.near + s.near_du * b.du + s.near_dv * b.dv;
}

/// @return whether any pixel of the block shows it
template <bool kGaussian>
[[gnu::always_inline]] inline bool set_block_surfel(const ProjectedSurfel& s, float left, float top,
                                                    std::size_t block, const Lanes& transparency,
                                                    BlockSurfel& b) {
  set_place(s, left, top, block, transparency, b);
  if (!any(b.shows)) return false;
  set_alpha<kGaussian>(s, b);
  return true;
}

}  // namespace slf
