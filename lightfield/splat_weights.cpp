#include "lightfield/splat_weights.h"

#include <cstddef>

#include "lightfield/splat_band.h"
#include "slf/parallel.h"

namespace slf {
namespace {

/// Weights of one band, by pixel.
struct BandWeights {
  std::vector<std::uint32_t> count;  // [pixels], then where the next entry of each pixel goes
  std::vector<std::uint32_t> point;
  std::vector<float> weight;
};

struct Entry {
  std::uint32_t pixel, point;
  float weight;
};

BandWeights sort_by_pixel(const std::vector<Entry>& entries, std::vector<std::uint32_t>&& count,
                          const std::vector<float>& scale) {
  BandWeights band{std::move(count), {}, {}};
  band.point.resize(entries.size());
  band.weight.resize(entries.size());
  std::vector<std::uint32_t> next(band.count.size());
  for (std::size_t i = 1; i < next.size(); ++i) next[i] = next[i - 1] + band.count[i - 1];
  for (const Entry& e : entries) {
    const std::uint32_t at = next[e.pixel]++;
    band.point[at] = e.point;
    band.weight[at] = e.weight * scale[e.pixel];
  }
  return band;
}

}  // namespace

SplatWeights splat_weights(const std::vector<Splat>& splats, int width, int height, int threads) {
  const std::size_t pixels = std::size_t(width) * std::size_t(height);
  SplatWeights out;
  out.coverage.assign(pixels, 0);
  out.depth.assign(pixels, 0);
  const auto bins = bin_splats(splats, height);
  std::vector<BandWeights> bands(bins.size());
  parallel_ranges(bins.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<Entry> entries;
    for (std::size_t i = begin; i < end; ++i) {
      SplatBand band(out.coverage, out.depth, width, height, i);
      std::vector<std::uint32_t> count(band.pixels());
      std::vector<float> scale(band.pixels());
      entries.clear();
      band.draw_depths(splats, bins[i]);
      const std::vector<std::uint32_t> shown = band.shown(splats, bins[i]);
      band.draw_weights(splats, shown, [&](std::uint32_t splat, std::size_t pixel, float weight) {
        entries.push_back({static_cast<std::uint32_t>(pixel), splats[splat].point, weight});
        ++count[pixel];
      });
      band.draw_coverage(splats, shown, bins[i]);
      band.normalise([&](std::size_t pixel, float factor) { scale[pixel] = factor; });
      bands[i] = sort_by_pixel(entries, std::move(count), scale);
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
