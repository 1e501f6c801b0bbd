// SPDX-License-Identifier: Apache-2.0
// How well points that stand somewhere agree with small photographs.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "slf/capture.h"

namespace slf {

/// A photograph, small.
struct WorldView {
  Camera camera;                              ///< of the small picture
  std::vector<std::array<float, 3>> colours;  ///< [height][width]
  std::vector<std::uint8_t> object;           ///< [height][width] or empty: where the object is
  std::vector<std::array<int, 2>> outline;    ///< a sample of its pixels
};

/// A dozen photographs, spread over the capture's. Those that cannot be read are left out: whoever
/// needs them will say so. Outlines: all of them have one, or none.
std::vector<WorldView> world_views(const Capture& capture, int threads);

/// Shares, 0 .. 1.
struct WorldAgreement {
  double in_view = 0;     ///< of points and views: the point is within the picture
  double on_object = 0;   ///< of these: the object is there; 1 without outlines
  double covered = 0;     ///< of the outlines: points are there; 1 without outlines
  bool outlines = false;  ///< there are some
  double common = 0;      ///< of the variance of colours: between points, not within one
  /// All of these in one.
  double score() const;
};

/// @param points  where they stand; a sample
/// O(points * views).
WorldAgreement world_agreement(std::span<const Vec3> points, std::span<const WorldView> views);

}  // namespace slf
