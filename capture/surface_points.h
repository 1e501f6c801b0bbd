// SPDX-License-Identifier: Apache-2.0
// The surface while it is being mended: points, who is next to whom, and smoothing over that.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace slf {

using Float3 = std::array<float, 3>;

inline float dot(const Float3& a, const Float3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Float3 minus(const Float3& a, const Float3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
/// a + s b
inline Float3 along(const Float3& a, float s, const Float3& b) {
  return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}

struct SurfacePoints {
  std::vector<Float3> positions;      ///< [P] world
  std::vector<Float3> normals;        ///< [P] unit, outward
  std::vector<std::uint32_t> source;  ///< [P] which point of the capture it comes from

  std::size_t size() const { return positions.size(); }
};

/// The k nearest others of every point and what they count: less with distance, nothing where they
/// face away (the other wall of a thin part).
struct SurfaceNeighbours {
  std::size_t k = 0;
  std::vector<std::uint32_t> index;  ///< [P][k]
  std::vector<float> weight;         ///< [P][k] 0 .. 1

  std::span<const std::uint32_t> of(std::size_t p) const { return {&index[p * k], k}; }
  std::span<const float> weights_of(std::size_t p) const { return {&weight[p * k], k}; }
};

/// @param reach  world units: standard deviation of the weight over distance
SurfaceNeighbours find_neighbours(const SurfacePoints& points, std::size_t k, double reach,
                                  int threads);

/// Planes through the neighbours; each normal stays on the side where it was.
std::vector<Float3> plane_normals(const SurfacePoints& points, const SurfaceNeighbours& neighbours,
                                  int threads);

/// How far along its normal each point is from the surface that its neighbours with their normals
/// make. Zero on a sphere of exact normals: chord and tangent planes err alike to either side.
std::vector<float> distance_to_neighbours(const SurfacePoints& points,
                                          const SurfaceNeighbours& neighbours, int threads);

/// positions += offset * normal
void move_along_normals(SurfacePoints& points, std::span<const float> offsets);

}  // namespace slf
