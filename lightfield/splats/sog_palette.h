// SPDX-License-Identifier: Apache-2.0
// Vectors of numbers by a palette of few: harmonics of SOG beyond degree 0.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace slf {

/// Rows of `dimensions` numbers, one behind the other. A multiple of 8, so that distances are sums
/// of eight lanes; what a vector does not need is 0.
struct VectorRows {
  std::size_t dimensions = 8;
  std::vector<float> numbers;

  std::size_t size() const { return numbers.size() / dimensions; }
  const float* operator[](std::size_t i) const { return &numbers[i * dimensions]; }
  float* operator[](std::size_t i) { return &numbers[i * dimensions]; }
};

struct VectorPalette {
  VectorRows vectors;                 ///< every one of them is used; neighbours are alike
  std::vector<std::uint32_t> labels;  ///< [rows] which vector stands for a row
};

/// k-means: the rows are halved, the cluster with most squared error first, until there are `most`
/// clusters; some rounds of Lloyd's method follow, in which a row looks at the clusters that are
/// numbered next to its own: all of them in small files, 64 to either side in large ones. The same
/// for any number of threads.
/// @param rows  1 or more, finite
/// @param most  1 or more
VectorPalette vector_palette(const VectorRows& rows, std::size_t most, int threads);

}  // namespace slf
