#include "render/framed_ball.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace slf {
namespace {

constexpr double kWide = 4;           // of the box of all, over that of most
constexpr std::size_t kFewest = 100;  // points of which a few can be told

struct VoxelBox {
  std::array<double, 3> low{}, high{};

  double largest_side() const {
    return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  }
  bool holds(const Voxel& v) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (v[k] < low[k] || v[k] > high[k]) return false;
    return true;
  }
};

/// Without a share of the points at either end of each axis.
VoxelBox box_of(std::span<const Voxel> positions, double tail) {
  VoxelBox box;
  const auto last = static_cast<double>(positions.size() - 1);
  std::vector<std::int32_t> values(positions.size());
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
VoxelBox framed_box(std::span<const Voxel> positions) {
  const VoxelBox all = box_of(positions, 0);
  if (positions.size() < kFewest) return all;
  VoxelBox most = box_of(positions, 0.01);
  if (!(all.largest_side() > kWide * most.largest_side()) || most.largest_side() == 0) return all;
  for (std::size_t k = 0; k < 3; ++k) {
    const double margin = (most.high[k] - most.low[k]) / 2;
    most.low[k] -= margin;
    most.high[k] += margin;
  }
  std::vector<Voxel> kept;
  std::copy_if(positions.begin(), positions.end(), std::back_inserter(kept),
               [&](const Voxel& v) { return most.holds(v); });
  return kept.empty() ? all : box_of(kept, 0);
}

}  // namespace

FramedBall framed_ball(const Grid& grid, std::span<const Voxel> positions) {
  FramedBall ball{grid.origin, 0};
  if (positions.empty()) return ball;
  const VoxelBox box = framed_box(positions);
  for (std::size_t k = 0; k < 3; ++k)
    ball.centre[k] = grid.origin[k] + grid.step * (box.low[k] + box.high[k]) / 2.0;
  for (const Voxel& v : positions) {
    if (!box.holds(v)) continue;
    const Vec3 p = grid.world(v);
    const double dx = p[0] - ball.centre[0], dy = p[1] - ball.centre[1], dz = p[2] - ball.centre[2];
    ball.radius = std::max(ball.radius, std::sqrt(dx * dx + dy * dy + dz * dz));
  }
  return ball;
}

}  // namespace slf
