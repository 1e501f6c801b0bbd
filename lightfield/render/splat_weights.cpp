// SPDX-License-Identifier: Apache-2.0
#include "lightfield/render/splat_weights.h"

#include <cstddef>
#include <limits>
#include <utility>

#include "lightfield/render/splat_band.h"
#include "slf/parallel.h"

namespace slf {
namespace {

/// Weights of one band, by pixel.
struct BandWeights {
  std::vector<std::uint32_t> count;  // [pixels], then where the next entry of each pixel goes
  std::vector<std::uint32_t> point;
  std::vector<float> weight;
};

BandWeights sort_by_pixel(const std::vector<SplatEntry>& entries, const std::vector<Splat>& splats,
                          std::vector<std::uint32_t>&& count, const std::vector<float>& scale) {
  BandWeights band{std::move(count), {}, {}};
  band.point.resize(entries.size());
  band.weight.resize(entries.size());
  std::vector<std::uint32_t> next(band.count.size());
  for (std::size_t i = 1; i < next.size(); ++i) next[i] = next[i - 1] + band.count[i - 1];
  for (const SplatEntry& e : entries) {
    const std::uint32_t at = next[e.pixel]++;
    band.point[at] = splats[e.splat].point;
    band.weight[at] = e.weight * scale[e.pixel];
  }
  return band;
}

}  // namespace

SplatWeights splat_weights(const std::vector<Splat>& splats, int width, int height, int threads) {
  const std::size_t pixels = std::size_t(width) * std::size_t(height);
  SplatWeights out;
  out.coverage.assign(pixels, 0);
  out.depth.assign(pixels, std::numeric_limits<float>::infinity());
  const auto bins = bin_splats(splats, height);
  std::vector<BandWeights> bands(bins.size());
  parallel_ranges(bins.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<SplatEntry> entries;
    BandSums sums;
    for (std::size_t i = begin; i < end; ++i) {
      SplatBand band(width, height, i);
      entries.clear();
      const std::vector<std::uint32_t> shown = band.find_shown(splats, bins[i]);
      band.list(splats, shown, sums, entries);
      band.cover(splats, shown, bins[i], sums);
      std::vector<std::uint32_t> count(band.pixels());
      for (const SplatEntry& e : entries) ++count[e.pixel];
      std::vector<float> scale(band.pixels());
      const std::size_t first = band.first_pixel();
      band.take(sums, [&](std::size_t pixel, const BlockSums& own, std::size_t lane) {
        scale[pixel] = 1 / own.weight[lane];
        out.coverage[first + pixel] = own.coverage[lane];
        out.depth[first + pixel] = own.weight[lane] / own.inverse_depth[lane];
      });
      bands[i] = sort_by_pixel(entries, splats, std::move(count), scale);
    }
  });
  std::size_t total = 0;
  for (const BandWeights& band : bands) total += band.point.size();
  out.first.reserve(pixels + 1);
  out.point.reserve(total);
  out.weight.reserve(total);
  out.first.push_back(0);
  for (BandWeights& band : bands) {
    for (const std::uint32_t n : band.count) out.first.push_back(out.first.back() + n);
    out.point.insert(out.point.end(), band.point.begin(), band.point.end());
    out.weight.insert(out.weight.end(), band.weight.begin(), band.weight.end());
    band = {};
  }
  return out;
}

}  // namespace slf
