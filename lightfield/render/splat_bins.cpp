// SPDX-License-Identifier: Apache-2.0
// Bands of an image: how they begin, and which splats touch each.
#include <algorithm>
#include <cmath>

#include "lightfield/render/splat_band.h"

namespace slf {

std::vector<std::vector<std::uint32_t>> bin_splats(const std::vector<Splat>& splats, int height) {
  std::vector<std::vector<std::uint32_t>> bins(std::size_t((height + kBandRows - 1) / kBandRows));
  for (std::size_t i = 0; i < splats.size(); ++i) {
    const Splat& s = splats[i];
    const int top = std::max(0, static_cast<int>(std::floor(s.v - s.half_height)) / kBandRows);
    const int bottom = std::min(static_cast<int>(bins.size()) - 1,
                                static_cast<int>(std::floor(s.v + s.half_height)) / kBandRows);
    for (int band = top; band <= bottom; ++band)
      bins[std::size_t(band)].push_back(static_cast<std::uint32_t>(i));
  }
  return bins;
}

SplatBand::SplatBand(int width, int height, std::size_t index)
    : width_(width),
      first_row_(static_cast<int>(index) * kBandRows),
      rows_(std::min(kBandRows, height - first_row_)),
      blocks_(std::size_t(width + 7) / 8 * kTileBlocks),
      tiles_(blocks_ / kTileBlocks),
      nearest_(std::size_t(rows_ + 7) / 8 * kTilePairs * blocks_),
      farthest_(nearest_.size() / (kTilePairs * kTileBlocks)),
      touched_(farthest_.size(), 0) {
  // To the right of the picture and below it.
  const float outside = std::numeric_limits<float>::infinity();
  const std::size_t pairs = nearest_.size() / blocks_;
  for (std::size_t pair = 0; pair < pairs; ++pair)
    for (std::size_t block = std::size_t(width) / 4; block < blocks_; ++block)
      for (std::size_t lane = 0; lane < 8; ++lane)
        if (4 * block + lane % 4 >= std::size_t(width))
          nearest_[pair * blocks_ + block].nearest[lane] = outside;
  for (std::size_t pair = std::size_t(rows_) / 2; pair < pairs; ++pair)
    for (std::size_t block = 0; block < blocks_; ++block)
      for (std::size_t lane = 0; lane < 8; ++lane)
        if (2 * pair + lane / 4 >= std::size_t(rows_))
          nearest_[pair * blocks_ + block].nearest[lane] = outside;
}

}  // namespace slf
