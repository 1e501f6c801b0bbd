// SPDX-License-Identifier: Apache-2.0
#include "slf/crop_gaussians.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/vec3.h"
#include "capture/crop.h"
#include "capture/quantile.h"
#include "lightfield/keep_splats.h"
#include "lightfield/splats/turn_gaussians.h"

namespace slf {
namespace {

constexpr int kMostBits = 21;           // of a grid
constexpr double kCoarsestVoxel = 0.1;  // of a deviation: that of the usual step (kGaussianQ)

bool is_inside(const Vec3& position, const WorldBox& box) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax(box.low[k], box.high[k]);
    if (!(position[k] >= low && position[k] <= high)) return false;
  }
  return true;
}

/// The median deviation along the middle axis, world units.
double typical_deviation(const Gaussians& splats) {
  std::vector<float> middle;
  middle.reserve(splats.size());
  for (std::array<float, 3> d : splats.log_deviations) {
    std::sort(d.begin(), d.end());
    middle.push_back(d[1]);
  }
  return std::exp(double{median(std::move(middle))});
}

}  // namespace

Result<Done, InputError> crop(Gaussians& splats, const WorldBox& box) {
  keep_splats(splats, [&](std::size_t p) {
    return is_inside(plus(splats.origin, to_double(splats.positions[p])), box);
  });
  if (splats.size() == 0)
    return InputError{Errc::kInvalidInput, "no splat is inside the box to crop to"};
  return Done{};
}

void change_world(const WorldChange& change, Gaussians& splats) {
  AxisRows rows{};
  for (std::size_t i = 0; i < 3; ++i)
    rows[i][static_cast<std::size_t>(std::abs(change.axes[i]) - 1)] = change.axes[i] < 0 ? -1 : 1;
  move_gaussians(splats, rows, change.scale);
  splats.origin = minus(change.apply(splats.origin), change.shift);
  shift_gaussians(splats, change.shift);
}

std::string far_splats_warning(const Gaussians& splats) {
  if (splats.size() == 0 ||
      std::ldexp(extent_of(splats), -kMostBits) <= kCoarsestVoxel * typical_deviation(splats))
    return "";
  return far_points_warning(splats.positions, splats.origin, "splats", "the file");
}

}  // namespace slf
