// SPDX-License-Identifier: Apache-2.0
#include "lightfield/splats/splat_directions.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include "lightfield/colour.h"

namespace slf {
namespace {

/// In extents of the scene. A direction is then off by no more than its inverse.
constexpr double kFar = 1e7;

float display_of(float linear) {
  return static_cast<float>(255 * linear_to_srgb(static_cast<double>(linear) / 255));
}

}  // namespace

std::vector<Vec3> even_directions(std::size_t count, double turn) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<Vec3> directions;
  for (std::size_t i = 0; i < count; ++i) {  // a spiral of equal areas
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double r = std::sqrt(1 - z * z), angle = golden * static_cast<double>(i) + turn;
    directions.push_back({r * std::cos(angle), r * std::sin(angle), z});
  }
  return directions;
}

DirectionSampler::DirectionSampler(const ViewMaps& maps, std::span<const Vec3> directions)
    : maps_(maps), linear_(maps.header().transfer == Transfer::kLinear) {
  const Grid& grid = maps.header().grid;
  const double extent = std::ldexp(grid.step, grid.bits);
  for (const Vec3& d : directions) {
    Vec3 eye;
    for (std::size_t k = 0; k < 3; ++k) eye[k] = grid.origin[k] + extent / 2 + kFar * extent * d[k];
    eyes_.push_back(eye);
  }
}

void DirectionSampler::sample(std::size_t begin, std::size_t end,
                              std::vector<std::array<float, 3>>& colours) const {
  std::vector<std::uint32_t> points(end - begin);
  std::iota(points.begin(), points.end(), static_cast<std::uint32_t>(begin));
  std::vector<std::array<float, 3>> seen(points.size());
  colours.resize(points.size() * eyes_.size());
  for (std::size_t j = 0; j < eyes_.size(); ++j) {
    maps_.radiances(eyes_[j], points, seen);
    for (std::size_t i = 0; i < points.size(); ++i) {
      auto& colour = colours[i * eyes_.size() + j] = seen[i];
      if (linear_)
        for (float& c : colour) c = display_of(c);
    }
  }
}

}  // namespace slf
