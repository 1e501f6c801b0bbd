// SPDX-License-Identifier: Apache-2.0
// Which splat counts where in an image, and how much: the one definition for pictures and for fits
// to pictures.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "lightfield/render/lanes.h"
#include "lightfield/render/render_splats.h"

namespace slf {

constexpr int kBandRows = 32;  // of one band: worked on by one thread, small enough for its cache

/// Indices of the splats that touch each band, ascending.
std::vector<std::vector<std::uint32_t>> bin_splats(const std::vector<Splat>& splats, int height);

/// Sums over the splats of eight pixels.
struct alignas(sizeof(Lanes)) BlockSums {
  Lanes weight, inverse_depth, red, green, blue;
  Lanes coverage;
};

/// The sums of one band, for one after the other.
struct BandSums {
  std::vector<BlockSums> blocks;  ///< [row pairs][columns / 4] 0 between two bands
};

/// A splat in a pixel of a band.
struct SplatEntry {
  std::uint32_t splat, pixel;
  float weight;
};

/// A band of rows. Its functions are called in this order, with the same splats and sums.
class SplatBand {
 public:
  SplatBand(int width, int height, std::size_t index);

  std::size_t first_pixel() const { return std::size_t(first_row_) * std::size_t(width_); }
  std::size_t pixels() const { return std::size_t(rows_) * std::size_t(width_); }

  /// Draws the depths of `all`, those that touch the band.
  /// @return those that any pixel shows
  std::vector<std::uint32_t> find_shown(const std::vector<Splat>& splats,
                                        const std::vector<std::uint32_t>& all);

  /// Sums weights and weighted colours, [splats].
  void blend(const std::vector<Splat>& splats, const std::vector<std::uint32_t>& shown,
             const std::vector<std::array<float, 4>>& colours, BandSums& sums) const;

  /// Or sums weights alone and appends each of them, splat by splat.
  void list(const std::vector<Splat>& splats, const std::vector<std::uint32_t>& shown,
            BandSums& sums, std::vector<SplatEntry>& entries) const;

  /// All splats of the band count, hidden ones too; those that show come first, as they leave
  /// little to do.
  void cover(const std::vector<Splat>& splats, const std::vector<std::uint32_t>& shown,
             const std::vector<std::uint32_t>& all, BandSums& sums) const;

  /// visit(pixel of the band, sums, lane) where anything is; sums become 0.
  template <class Visit>
  void take(BandSums& sums, Visit&& visit) const {
    for (std::size_t tile = 0; tile < touched_.size(); ++tile) {
      if (touched_[tile] == 0) continue;
      for (std::size_t i = 0; i < kTilePairs * kTileBlocks; ++i) {
        const std::size_t block = block_of(tile, i);
        BlockSums& own = sums.blocks[block];
        const std::size_t pixel = first_pixel_of(block);
        for (std::size_t lane = 0; lane < 8; ++lane)
          if (own.weight[lane] > 0)
            visit(pixel + lane / 4 * std::size_t(width_) + lane % 4, own, lane);
        own = BlockSums{};
      }
    }
  }

 private:
  static constexpr std::size_t kTilePairs = 4, kTileBlocks = 2;  // 8 x 8 pixels are judged at once

  struct alignas(sizeof(Lanes)) Block {
    Lanes nearest;
  };
  /// Tiles that a splat may touch, inclusive.
  struct TileBox {
    std::size_t left, right, top, bottom;
  };

  /// Where there are pixels that show something but are not wholly covered.
  struct OpenPixels {
    std::vector<std::uint8_t> tiles, blocks;
  };

  /// The i-th block of a tile.
  std::size_t block_of(std::size_t tile, std::size_t i) const {
    return (tile / tiles_ * kTilePairs + i / kTileBlocks) * blocks_ + tile % tiles_ * kTileBlocks +
           i % kTileBlocks;
  }
  /// The pixel of its lane 0.
  std::size_t first_pixel_of(std::size_t block) const {
    return 2 * (block / blocks_) * std::size_t(width_) + 4 * (block % blocks_);
  }
  TileBox tiles_of(const Splat& s) const;
  void draw_depth(const Splat& s);
  void find_farthest();
  bool shows_at_centre(const Splat& s) const;
  bool shows_anywhere(const Splat& s) const;
  template <class Visit>
  void visit(const Splat& s, float reach, Visit&& visit) const;
  template <class Add>
  void draw_weight(const Splat& s, BandSums& sums, Add&& add) const;
  void cover_by_density(BandSums& sums) const;
  void find_open(const BandSums& sums, OpenPixels& open) const;
  void cover_by_disc(const Splat& s, BandSums& sums, const OpenPixels& open) const;

  int width_, first_row_, rows_;
  std::size_t blocks_, tiles_;         // in a row
  std::vector<Block> nearest_;         // [row pairs][blocks] greatest inverse depth; outside of the
                                       // picture infinite, so that nothing shows
  std::vector<float> farthest_;        // [tiles] least of nearest_
  std::vector<std::uint8_t> touched_;  // [tiles] has a splat that shows
};

}  // namespace slf
