// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/terrace_patterns.h"

#include "tools/synth/noise.h"

namespace slf::synth {

FaceCoordinates face_coordinates(const Solid& solid, const SurfacePoint& point) {
  const Vec3 &p = point.position, &n = point.normal;
  if (solid.shape == Shape::kSphere || (solid.shape == Shape::kCylinder && std::abs(n[2]) < 0.5)) {
    const double radius = (solid.high[0] - solid.low[0]) / 2;
    return {radius * std::atan2(n[1], n[0]), p[2]};
  }
  if (std::abs(n[0]) > 0.9) return {p[1], p[2]};
  if (n[2] > 0.95 || n[2] < -0.5) return {p[0], p[1]};
  // Up a slope a step of z is one of 1 / sin of its angle.
  return {p[0], p[2] / std::max(0.2, std::sqrt(1 - n[2] * n[2]))};
}

double shown(double size, double footprint) {
  return 1 - smoothstep(0.35 * size, 1.0 * size, footprint);
}

Cell bond(const FaceCoordinates& at, const Bond& stones, std::uint32_t seed) {
  const double course = std::floor(at.v / stones.height);
  const double along = at.u / stones.width + stones.shift * course;
  const double column = std::floor(along);
  const double u = (along - column) * stones.width, v = at.v - course * stones.height;
  const double to_u = std::min(u, stones.width - u), to_v = std::min(v, stones.height - v);
  Cell cell{cell_bits(column, course, seed), std::min(to_u, to_v), v, 0, 0};
  if (to_u < to_v)
    cell.towards_u = u < stones.width - u ? -1 : 1;
  else
    cell.towards_v = v < stones.height - v ? -1 : 1;
  return cell;
}

}  // namespace slf::synth
