// SPDX-License-Identifier: Apache-2.0
// The order in which photographs are coded: from each to one that looks alike. Paper IV-F.
#pragma once

#include <span>
#include <vector>

#include "slf/capture.h"

namespace slf {

/// How much two views differ: distance of the centres, in units of the cameras' spread, and of the
/// unit viewing directions, as one Euclidean length.
class ViewDistance {
 public:
  ViewDistance(const Capture& capture, std::span<const int> cameras);
  /// Between the cameras at two places of the given list.
  double operator()(int a, int b) const;

 private:
  std::vector<std::array<double, 6>> views_;
};

/// Places of `cameras`, each once, beginning with place 0: nearest neighbours, then 2-opt until no
/// reversal of a part makes the walk shorter. Never longer than the given order. Deterministic.
/// O(n^2) per round.
std::vector<int> camera_walk(const Capture& capture, std::span<const int> cameras);

/// Sum of the distances between neighbours of a walk.
double walk_length(const ViewDistance& distance, std::span<const int> walk);

}  // namespace slf
