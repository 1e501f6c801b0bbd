// SPDX-License-Identifier: Apache-2.0
// Front to back blending of a tile, eight pixels at a time.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/multiversion.h"
#include "lightfield/render/gaussian_tiles.h"
#include "lightfield/render/lanes.h"

namespace slf {
namespace {

constexpr std::size_t kBlockColumns = 4, kBlockRows = 2;
constexpr std::size_t kBlocksAcross = kGaussianTile / kBlockColumns;
constexpr std::size_t kBlocksDown = kGaussianTile / kBlockRows;
constexpr float kHalfClear = 0.5f;  // of a pixel, with which it has a depth

/// The sums of eight pixels: four columns of two rows.
struct alignas(sizeof(Lanes)) PixelBlock {
  Lanes clear;  // what is left of the background; negative: the pixel is done
  Lanes red, green, blue, depth;
};

using PixelBlocks = std::array<PixelBlock, kBlocksAcross * kBlocksDown>;

/// 2^x of -126 .. 0, to 3e-6 of it: a power of two, and a series for the rest, half of one at most.
[[gnu::always_inline]] inline void set_power_of_two(const Lanes& x, Lanes& out) {
  const LaneMask whole = __builtin_convertvector(x - 0.5f, LaneMask);  // towards 0: the nearest
  const Lanes f = x - __builtin_convertvector(whole, Lanes);
  const Lanes series =
      1.0f + f * (0.69314718f +
                  f * (0.24022651f + f * (0.055504109f + f * (0.0096181291f + f * 0.0013333558f))));
  const LaneMask exponent = (whole + 127) << 23;
  Lanes power;
  std::memcpy(&power, &exponent, sizeof power);
  out = series * power;
}

/// A splat over eight pixels.
/// @param square  squared deviations from its centre
/// @return whether a pixel is done that was not
[[gnu::always_inline]] inline bool blend_block(const ProjectedGaussian& s, const Lanes& square,
                                               const LaneMask& inside, PixelBlock& block) {
  constexpr float kToBits = -0.72134752f;  // exp(-x / 2) = 2^(x kToBits)
  Lanes alpha;
  const Lanes positive = square > 0.0f ? square : Lanes{};  // of long ellipses it may be less
  const Lanes bits = kToBits * (positive < s.reach ? positive : Lanes{} + s.reach);
  set_power_of_two(bits, alpha);
  alpha *= s.opacity;
  alpha = alpha < GaussianKernel::most_alpha ? alpha : Lanes{} + GaussianKernel::most_alpha;
  const Lanes clear = block.clear;
  const Lanes after = clear * (1.0f - alpha);  // negative where the pixel is done
  const LaneMask drawn = inside & (after >= GaussianKernel::least_clear);
  const Lanes weight = drawn ? alpha * clear : Lanes{};
  block.red += weight * s.red;
  block.green += weight * s.green;
  block.blue += weight * s.blue;
  const LaneMask half = drawn & (clear > kHalfClear) & (after <= kHalfClear);
  block.depth = half ? Lanes{} + s.depth : block.depth;
  const LaneMask done = inside & (clear > 0.0f) & (after < GaussianKernel::least_clear);
  block.clear = drawn ? after : (done ? -clear : clear);
  return any(done);
}

/// PixelBlocks first .. last of a side that lie between two coordinates, of pixel centres.
struct BlockRange {
  std::size_t first, last;  // first > last: none
};
[[gnu::always_inline]] inline BlockRange blocks_between(float low, float high, std::size_t size) {
  constexpr auto kLast = static_cast<float>(kGaussianTile - 1);
  const float from = std::ceil(low - 0.5f), to = std::floor(high - 0.5f);
  if (!(from <= kLast && to >= 0 && from <= to)) return {1, 0};
  return {static_cast<std::size_t>(std::max(from, 0.0f)) / size,
          static_cast<std::size_t>(std::min(to, kLast)) / size};
}

/// All splats of a tile whose top left pixel is at (left, top).
SLF_MULTIVERSION_ALL void blend_blocks(const ProjectedGaussian* splats,
                                       std::span<const std::uint32_t> own, float left, float top,
                                       PixelBlocks& blocks) {
  std::array<bool, kBlocksAcross * kBlocksDown> closed{};
  std::size_t open = blocks.size();
  for (const std::uint32_t i : own) {
    const ProjectedGaussian& s = splats[i];
    const float u = s.u - left, v = s.v - top;
    const BlockRange across = blocks_between(u - s.half_width, u + s.half_width, kBlockColumns);
    const BlockRange down = blocks_between(v - s.half_height, v + s.half_height, kBlockRows);
    if (across.first > across.last) continue;
    for (std::size_t y = down.first; y <= down.last; ++y) {
      const Lanes dv = (static_cast<float>(kBlockRows * y) + 0.5f - v) + kRows;
      const Lanes mixed = 2 * s.b * dv, along = s.c * dv * dv;
      for (std::size_t x = across.first; x <= across.last; ++x) {
        const std::size_t index = y * kBlocksAcross + x;
        if (closed[index]) continue;
        const Lanes du = (static_cast<float>(kBlockColumns * x) + 0.5f - u) + kColumns;
        const Lanes square = du * (s.a * du + mixed) + along;
        const LaneMask inside = square < s.reach;
        if (!any(inside) || !blend_block(s, square, inside, blocks[index])) continue;
        closed[index] = !any(blocks[index].clear > 0.0f);
        if (closed[index] && --open == 0) return;
      }
    }
  }
}

/// A sum over what is left of the background, as a sample of 8 bits.
std::uint8_t sample_of(float colour, float clear, std::uint8_t background) {
  const float value = 255 * colour + clear * static_cast<float>(background);
  return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 255.0f) + 0.5f);
}

}  // namespace

void blend_tile(const std::vector<ProjectedGaussian>& splats, const GaussianTiles& tiles,
                std::size_t tile, const std::array<std::uint8_t, 3>& background, Rendering& out) {
  const auto width = std::size_t(out.image.width), height = std::size_t(out.image.height);
  const std::size_t left = tile % std::size_t(tiles.columns) * kGaussianTile;
  const std::size_t top = tile / std::size_t(tiles.columns) * kGaussianTile;
  const Lanes nothing{};
  PixelBlocks blocks;
  blocks.fill({nothing + 1.0f, nothing, nothing, nothing,
               nothing + std::numeric_limits<float>::infinity()});
  blend_blocks(splats.data(), tiles.of(tile), float(left), float(top), blocks);
  for (std::size_t y = 0; y < std::min<std::size_t>(kGaussianTile, height - top); ++y)
    for (std::size_t x = 0; x < std::min<std::size_t>(kGaussianTile, width - left); ++x) {
      const PixelBlock& block = blocks[y / kBlockRows * kBlocksAcross + x / kBlockColumns];
      const std::size_t lane = y % kBlockRows * kBlockColumns + x % kBlockColumns;
      const std::size_t pixel = (top + y) * width + left + x;
      const float clear = std::abs(block.clear[lane]);
      std::uint8_t* sample = &out.image.data[3 * pixel];
      sample[0] = sample_of(block.red[lane], clear, background[0]);
      sample[1] = sample_of(block.green[lane], clear, background[1]);
      sample[2] = sample_of(block.blue[lane], clear, background[2]);
      out.coverage[pixel] = static_cast<std::uint8_t>(255 * (1 - clear) + 0.5f);
      out.depth[pixel] = block.depth[lane];
    }
}

}  // namespace slf
