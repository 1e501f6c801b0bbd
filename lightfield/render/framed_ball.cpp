// SPDX-License-Identifier: Apache-2.0
#include "lightfield/render/framed_ball.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace slf {
namespace {

constexpr double kWide = 4;                  // of the box of all, over that of most
constexpr double kStray = 0.01, kSky = 0.1;  // shares of points, of splats, that most is without
constexpr std::size_t kFewest = 100;         // points of which a few can be told

struct Box {
  std::array<double, 3> low{}, high{};

  double largest_side() const {
    return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  }
  template <class Number>
  bool holds(const std::array<Number, 3>& v) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (static_cast<double>(v[k]) < low[k] || static_cast<double>(v[k]) > high[k]) return false;
    return true;
  }
};

/// Without a share of the points at either end of each axis.
template <class Number>
Box box_of(std::span<const std::array<Number, 3>> positions, double tail) {
  Box box;
  const auto last = static_cast<double>(positions.size() - 1);
  std::vector<Number> values(positions.size());
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t p = 0; p < values.size(); ++p) values[p] = positions[p][k];
    const auto at = [&](double share) {
      const auto nth = values.begin() + static_cast<std::ptrdiff_t>(share * last);
      std::nth_element(values.begin(), nth, values.end());
      return static_cast<double>(*nth);
    };
    box.low[k] = at(tail);
    box.high[k] = at(1 - tail);
  }
  return box;
}

/// The box of all points, or where a few are far away about the others, half of these to each side.
template <class Number>
Box framed_box(std::span<const std::array<Number, 3>> positions, double tail) {
  const Box all = box_of(positions, 0);
  if (positions.size() < kFewest) return all;
  Box most = box_of(positions, tail);
  if (!(all.largest_side() > kWide * most.largest_side()) || most.largest_side() == 0) return all;
  for (std::size_t k = 0; k < 3; ++k) {
    const double margin = (most.high[k] - most.low[k]) / 2;
    most.low[k] -= margin;
    most.high[k] += margin;
  }
  std::vector<std::array<Number, 3>> kept;
  std::copy_if(positions.begin(), positions.end(), std::back_inserter(kept),
               [&](const auto& v) { return most.holds(v); });
  return kept.empty() ? all : box_of(std::span<const std::array<Number, 3>>(kept), 0);
}

/// @param tail   share of the points at either end of an axis that may lie far away
/// @param world  coordinates to world units
template <class Number, class World>
FramedBall ball_of(std::span<const std::array<Number, 3>> positions, double tail,
                   const World& world) {
  FramedBall ball{world(Vec3{0, 0, 0}), 0};
  if (positions.empty()) return ball;
  const Box box = framed_box(positions, tail);
  ball.centre = world(Vec3{(box.low[0] + box.high[0]) / 2.0, (box.low[1] + box.high[1]) / 2.0,
                           (box.low[2] + box.high[2]) / 2.0});
  for (const auto& v : positions) {
    if (!box.holds(v)) continue;
    const Vec3 p = world(
        Vec3{static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])});
    const double dx = p[0] - ball.centre[0], dy = p[1] - ball.centre[1], dz = p[2] - ball.centre[2];
    ball.radius = std::max(ball.radius, std::sqrt(dx * dx + dy * dy + dz * dz));
  }
  return ball;
}

}  // namespace

FramedBall framed_ball(const Grid& grid, std::span<const Voxel> positions) {
  return ball_of(positions, kStray, [&](const Vec3& v) {
    return Vec3{grid.origin[0] + grid.step * v[0], grid.origin[1] + grid.step * v[1],
                grid.origin[2] + grid.step * v[2]};
  });
}

FramedBall framed_ball(std::span<const std::array<float, 3>> positions) {
  return ball_of(positions, kSky, [](const Vec3& v) { return v; });
}

}  // namespace slf
