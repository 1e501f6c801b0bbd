// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/fit_neighbours.h"

#include <algorithm>
#include <array>

#include "capture/nearest.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kQueriesPerRange = 1024;

/// Exact: voxels have 21 bits, a float 24.
std::array<float, 3> to_float(const Voxel& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

std::vector<std::array<float, 3>> to_float(std::span<const Voxel> voxels) {
  std::vector<std::array<float, 3>> points;
  points.reserve(voxels.size());
  for (const Voxel& v : voxels) points.push_back(to_float(v));
  return points;
}

}  // namespace

Neighbours nearest_neighbours(std::span<const Voxel> positions, int k, int threads) {
  Neighbours neighbours;
  if (positions.size() < 2) return neighbours;
  neighbours.count = std::min(static_cast<std::size_t>(k), positions.size() - 1);
  neighbours.index.resize(positions.size() * neighbours.count);
  const auto points = to_float(positions);
  const NearestPoints tree(points);
  const auto body = [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> found(neighbours.count +
                                     1);  // the point itself first, at distance 0
    for (std::size_t p = begin; p < end; ++p) {
      tree.nearest(points[p], static_cast<int>(found.size()), found.data(), nullptr);
      std::copy_n(found.data() + 1, neighbours.count,
                  neighbours.index.data() + p * neighbours.count);
    }
  };
  parallel_ranges(positions.size(), kQueriesPerRange, threads, body);
  return neighbours;
}

std::vector<std::uint32_t> nearest_position(std::span<const Voxel> positions,
                                            std::span<const Voxel> queries, int threads) {
  std::vector<std::uint32_t> index(queries.size());
  const auto points = to_float(positions);
  const NearestPoints tree(points);
  parallel_ranges(queries.size(), kQueriesPerRange, threads,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t q = begin; q < end; ++q)
                      tree.nearest(to_float(queries[q]), 1, &index[q], nullptr);
                  });
  return index;
}

}  // namespace slf
