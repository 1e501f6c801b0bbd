// SPDX-License-Identifier: Apache-2.0
// A surface whose every property is known, for tests of what mends surfaces.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>

#include "capture/surface_points.h"

namespace slf {

/// A sphere of radius 1 by the golden spiral, normals exact.
inline SurfacePoints sphere(std::size_t count) {
  SurfacePoints points;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - (2 * double(i) + 1) / double(count), r = std::sqrt(1 - z * z);
    const double turn = std::numbers::pi * (3 - std::sqrt(5.0)) * double(i);
    const Float3 n{float(r * std::cos(turn)), float(r * std::sin(turn)), float(z)};
    points.positions.push_back(n);
    points.normals.push_back(n);
    points.source.push_back(std::uint32_t(i));
  }
  return points;
}

inline double radius(const Float3& p) { return std::sqrt(double(dot(p, p))); }

}  // namespace slf
