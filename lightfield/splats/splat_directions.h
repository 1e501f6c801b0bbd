// SPDX-License-Identifier: Apache-2.0
// Directions over the sphere, and what a light field shows along them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "slf/splats.h"

namespace slf {

/// Evenly spread unit vectors. Sets with another turn share none.
std::vector<Vec3> even_directions(std::size_t count, double turn);

/// Colours of a run of points in display values, 0 .. 255.
class DirectionSampler {
 public:
  /// @param directions  unit, world, from the point to the eye; both are kept by reference
  DirectionSampler(const ViewMaps& maps, std::span<const Vec3> directions);

  /// @param colours  [end - begin][directions] receives R, G, B
  void sample(std::size_t begin, std::size_t end, std::vector<std::array<float, 3>>& colours) const;

 private:
  const ViewMaps& maps_;
  std::vector<Vec3> eyes_;  // so far that all points see them along the same direction
  bool linear_;
};

/// What a direction counts for at a point: how large its surface is seen from there, times the
/// share of views from that side.
inline float weight_of(const std::array<float, 3>& normal, float front, const Vec3& direction) {
  if (normal[0] == 0 && normal[1] == 0 && normal[2] == 0) return 1;
  const float cosine = normal[0] * float(direction[0]) + normal[1] * float(direction[1]) +
                       normal[2] * float(direction[2]);
  return cosine > 0 ? cosine * front : -cosine * (1 - front);
}

}  // namespace slf
