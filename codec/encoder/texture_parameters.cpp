// SPDX-License-Identifier: Apache-2.0
#include "codec/encoder/texture_parameters.h"

#include <algorithm>

#include "attributes/texture/atlas.h"

namespace slf {
namespace {

constexpr std::size_t kFewLoose = 16;  // one in so many points

/// Points outside charts; all of them where the texture would be too large.
std::size_t loose_points(std::span<const std::uint64_t> morton, int grid_bits, int cell_log2) {
  const auto atlas = derive_atlas(morton, grid_bits, cell_log2);
  return atlas ? atlas->num_loose : morton.size();
}

}  // namespace

int texture_cell_log2(std::span<const std::uint64_t> morton, int grid_bits) {
  int best = 0;
  std::size_t fewest = loose_points(morton, grid_bits, 0);
  for (int log2 = 1; log2 <= kMostCellLog2 && fewest >= morton.size() / kFewLoose; ++log2)
    if (const std::size_t loose = loose_points(morton, grid_bits, log2); loose < fewest) {
      fewest = loose;
      best = log2;
    }
  return best;
}

std::vector<std::uint32_t> least_texture_steps(std::span<const std::int32_t> components,
                                               std::size_t planes, int bits) {
  const std::int64_t most = (std::int64_t{1} << bits) - 1;
  std::vector<std::uint32_t> steps(planes, 1);
  const auto row = components.first(planes);
  std::vector<std::int32_t> least(row.begin(), row.end()), greatest = least;
  for (std::size_t i = 0; i < components.size(); ++i) {
    least[i % planes] = std::min(least[i % planes], components[i]);
    greatest[i % planes] = std::max(greatest[i % planes], components[i]);
  }
  for (std::size_t j = 0; j < planes; ++j) {
    const std::int64_t range = std::int64_t{greatest[j]} - least[j];
    steps[j] = std::max(steps[j], static_cast<std::uint32_t>((range + most - 1) / most));
  }
  return steps;
}

}  // namespace slf
