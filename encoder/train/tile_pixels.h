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

/// Blocks of a tile that a surfel may touch, inclusive.
struct BlockBox {
  int left, right, top, bottom;
};
[[gnu::always_inline]] inline BlockBox blocks_of(const ProjectedSurfel& s, float left, float top) {
  const auto clamp = [](float x) {
    return int(x < 0 ? 0 : x > float(kTileSide) ? float(kTileSide) : x);
  };
  const float u = s.u - left - 0.5f, v = s.v - top - 0.5f;  // a pixel's centre is at its index
  const int right = clamp(u + s.half_width), bottom = clamp(v + s.half_height);
  return {clamp(u - s.half_width + 1) / kBlockColumns, (right < 15 ? right : 15) / kBlockColumns,
          clamp(v - s.half_height + 1) / kBlockRows, (bottom < 15 ? bottom : 15) / kBlockRows};
}

[[gnu::always_inline]] inline float sum_of(const Lanes& lanes) {
  std::array<float, 8> v;
  std::memcpy(v.data(), &lanes, sizeof lanes);
  return ((v[0] + v[4]) + (v[1] + v[5])) + ((v[2] + v[6]) + (v[3] + v[7]));
}

/// Pixels of a block to and from a picture's plane; those outside are left out, or `outside`.
struct BlockPlace {
  int x, y, width, height;
};
[[gnu::always_inline]] inline void store_block(const Lanes& lanes, const BlockPlace& at,
                                               float* plane) {
  std::array<float, 8> v;
  std::memcpy(v.data(), &lanes, sizeof lanes);
  for (int r = 0; r < kBlockRows && at.y + r < at.height; ++r)
    for (int k = 0; k < kBlockColumns && at.x + k < at.width; ++k)
      plane[std::size_t(at.y + r) * std::size_t(at.width) + std::size_t(at.x + k)] =
          v[std::size_t(kBlockColumns * r + k)];
}
[[gnu::always_inline]] inline void load_block(const float* plane, const BlockPlace& at,
                                              float outside, Lanes& lanes) {
  std::array<float, 8> v;
  v.fill(outside);
  for (int r = 0; r < kBlockRows && at.y + r < at.height; ++r)
    for (int k = 0; k < kBlockColumns && at.x + k < at.width; ++k)
      v[std::size_t(kBlockColumns * r + k)] =
          plane[std::size_t(at.y + r) * std::size_t(at.width) + std::size_t(at.x + k)];
  std::memcpy(&lanes, v.data(), sizeof lanes);
}

/// A surfel in the pixels of a block.
struct BlockSurfel {
  Lanes du, dv, inside, kernel, alpha, near;
  LaneMask shows;
};
/// exp(-reach r2 / 2) for r2 of 0 .. 1: within 2 % of itself where it is least, 0.02 % at one
/// deviation.
[[gnu::always_inline]] inline void set_gaussian(const Lanes& r2, Lanes& k) {
  const Lanes x = r2 * (-kGaussianReach / 2 / 32);
  k = 1 + x * (1 + 0.5f * x);
  for (int i = 0; i < 5; ++i) k = k * k;
}

/// @param x, y  pixel of the block's corner
/// @return whether any pixel shows it
template <bool kGaussian>
[[gnu::always_inline]] inline bool set_block_surfel(const ProjectedSurfel& s, float x, float y,
                                                    const Lanes& transparency, BlockSurfel& b) {
  b.du = (x + 0.5f - s.u) + kColumns;
  b.dv = (y + 0.5f - s.v) + kRows;
  const Lanes r2 = b.du * (s.a * b.du + 2 * s.b * b.dv) + s.c * b.dv * b.dv;
  b.shows = (r2 < 1.0f) & (transparency > kLeastTransparency);
  if (!any(b.shows)) return false;
  b.inside = b.shows ? 1 - r2 : Lanes{};
  const Lanes square = b.inside * b.inside;
  if constexpr (kGaussian) {
    set_gaussian(r2, b.kernel);
    b.kernel = b.shows ? b.kernel : Lanes{};
  } else {
    b.kernel = square * square;
  }
  const Lanes alpha = s.opacity * b.kernel;
  b.alpha = alpha < kMostAlpha ? alpha : Lanes{} + kMostAlpha;
  b.near = s.near + s.near_du * b.du + s.near_dv * b.dv;
  return true;
}

}  // namespace slf
