// SPDX-License-Identifier: Apache-2.0
// Nearest points of a cloud, ties included in the promise. The adapter of nanoflann.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

namespace slf {

/// A k-d tree over points. Distances are compared in double, where those of voxels are exact, and
/// equal distances by index, so that an answer depends on nothing but the points and the query.
/// Thread-safe once built. O(P log P) to build.
class NearestPoints {
 public:
  /// Keeps a reference to the data of `points`. Finite; may be empty.
  explicit NearestPoints(std::span<const std::array<float, 3>> points);
  ~NearestPoints();
  NearestPoints(NearestPoints&&) noexcept;
  NearestPoints& operator=(NearestPoints&&) noexcept;

  /// The k nearest points in ascending (distance, index); a query that is itself a point of the
  /// cloud finds it. Squared distances are rounded to float; may be null.
  /// @param k  1 .. number of points
  void nearest(const std::array<float, 3>& query, int k, std::uint32_t* indices,
               float* squared_distances) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace slf
