// SPDX-License-Identifier: Apache-2.0
#include "capture/exact_positions.h"

#include <algorithm>
#include <cmath>

#include "base/vec3.h"
#include "capture/voxelise.h"

namespace slf {

namespace {

constexpr double kMostLost = 1e-7;  // of the extent; a voxel of the finest grid is 4.8e-7

struct Spread {
  Box box;
  double magnitude = 0;
  double lost = 0;  // by a coordinate, as a float
  bool finite = true;
};

Spread spread_of(std::span<const Vec3> exact) {
  Spread found;
  if (!exact.empty()) found.box = {exact[0], exact[0]};
  for (const Vec3& v : exact)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto rounded = static_cast<float>(v[k]);
      found.finite = found.finite && std::isfinite(rounded);
      found.box.min[k] = std::min(found.box.min[k], v[k]);
      found.box.max[k] = std::max(found.box.max[k], v[k]);
      found.magnitude = std::max(found.magnitude, std::abs(v[k]));
      found.lost = std::max(found.lost, std::abs(v[k] - static_cast<double>(rounded)));
    }
  return found;
}

Vec3 origin_of(const Spread& all) {
  const double extent = all.box.largest_extent();
  const double scale = extent > 0 ? extent : 1;  // a single place: of a unit
  if (!all.finite || !(all.lost > kMostLost * scale)) return {0, 0, 0};
  // A double has 53 bits: a smaller multiple would not be exact.
  const int exponent = std::max(std::ilogb(scale), std::ilogb(all.magnitude) - 50);
  const double unit = std::ldexp(1.0, exponent);
  Vec3 origin{};
  for (std::size_t k = 0; k < 3; ++k) origin[k] = std::floor(all.box.min[k] / unit) * unit;
  return origin;
}

}  // namespace

void set_positions(std::span<const Vec3> exact, PointCloud& cloud) {
  const Vec3 origin = cloud.origin = origin_of(spread_of(exact));
  cloud.positions.clear();
  cloud.positions.reserve(exact.size());
  for (const Vec3& v : exact)
    cloud.positions.push_back(to_float({v[0] - origin[0], v[1] - origin[1], v[2] - origin[2]}));
}

}  // namespace slf
