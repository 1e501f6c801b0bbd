// SPDX-License-Identifier: Apache-2.0
// Observations as a fit reads them: point by point, from where they are kept, or made when they
// are read.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "slf/fit.h"

namespace slf {

/// What was seen of one point.
struct SeenPoint {
  std::span<const std::array<float, 2>> direction;
  std::span<const std::array<float, 3>> colour;
  std::span<const std::uint16_t> camera;

  std::size_t count() const { return direction.size(); }
};

/// Room for a point whose observations are made when they are read: each thread has its own.
struct SeenRoom {
  std::vector<std::array<float, 2>> direction;
  std::vector<std::array<float, 3>> colour;
  std::vector<std::uint16_t> camera;

  SeenPoint seen() const { return {direction, colour, camera}; }
};

/// Thread-safe, light to copy. A point has the same observations whenever it is read.
class PointwiseObservations {
 public:
  using Make = std::function<SeenPoint(std::size_t point, SeenRoom& room)>;

  /// @param kept  by reference
  PointwiseObservations(const Observations& kept)  // NOLINT(google-explicit-constructor)
      : kept_(&kept), points_(kept.first.empty() ? 0 : kept.first.size() - 1) {}

  /// Every point has `each`, which `make` makes in the room that it gets.
  PointwiseObservations(std::size_t points, std::size_t each, Make make)
      : points_(points), each_(each), make_(std::move(make)) {}

  std::size_t points() const { return points_; }
  /// Observations of the points before this one; of all for points().
  std::size_t first(std::size_t point) const {
    return kept_ != nullptr ? static_cast<std::size_t>(kept_->first[point]) : point * each_;
  }
  std::size_t count(std::size_t point) const { return first(point + 1) - first(point); }
  std::size_t count() const { return first(points_); }
  /// Whether they lie in memory; then what is as large may lie there too.
  bool kept() const { return !make_; }

  /// @param room  what is returned may lie in it
  SeenPoint of(std::size_t point, SeenRoom& room) const;

  /// The same with directions mirrored at normals, which are kept by reference; none: the same.
  PointwiseObservations mirrored_at(std::span<const std::array<float, 3>> normals) const;

 private:
  const Observations* kept_ = nullptr;
  std::size_t points_ = 0, each_ = 0;
  Make make_;  // none: they are those kept
};

}  // namespace slf
