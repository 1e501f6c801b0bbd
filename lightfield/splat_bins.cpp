#include <algorithm>
#include <cmath>

#include "lightfield/splat_band.h"

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

}  // namespace slf
