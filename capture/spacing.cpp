// SPDX-License-Identifier: Apache-2.0
#include "capture/spacing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "capture/nearest.h"

namespace slf {

double typical_spacing(std::span<const std::array<float, 3>> points) {
  if (points.size() < 2) return 0;
  constexpr std::size_t kSamples = 2000;
  const int k = static_cast<int>(std::min<std::size_t>(points.size(), 5));  // itself and four more
  const NearestPoints tree(points);
  std::vector<std::uint32_t> index(static_cast<std::size_t>(k));
  std::vector<float> squared(static_cast<std::size_t>(k));
  const std::size_t stride = std::max<std::size_t>(points.size() / kSamples, 1);
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t p = 0; p < points.size(); p += stride, ++count) {
    tree.nearest(points[p], k, index.data(), squared.data());
    sum += std::sqrt(static_cast<double>(squared.back()));
  }
  return sum / static_cast<double>(count);
}

}  // namespace slf
