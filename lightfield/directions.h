// SPDX-License-Identifier: Apache-2.0
// Directions as the functions of a point take them: local ones. Spec 6.4.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "slf/types.h"
#include "slf/view_map.h"

namespace slf {

/// The unit vector of (theta, gamma).
inline Vec3 vector_of(const std::array<float, 2>& direction) {
  const double gamma = static_cast<double>(direction[1]);
  const double r = std::sqrt(std::max(0.0, 1 - gamma * gamma));
  const double theta = static_cast<double>(direction[0]);
  return {r * std::cos(theta), r * std::sin(theta), gamma};
}

/// [P] unit normals, of either sign, that directions are mirrored at; empty for those of the world.
/// @param positions  of all points of the light field, Morton order
/// @param cell_log2  LightFieldHeader::normal_cell_log2
std::vector<std::array<float, 3>> mirror_normals(Directions directions,
                                                 std::span<const Voxel> positions, int cell_log2,
                                                 int threads);

/// 2 (n . w) n - w.
inline Vec3 mirrored(const std::array<float, 3>& n, const Vec3& w) {
  const double twice = 2 * (w[0] * double(n[0]) + w[1] * double(n[1]) + w[2] * double(n[2]));
  return {twice * double(n[0]) - w[0], twice * double(n[1]) - w[1], twice * double(n[2]) - w[2]};
}

/// World (theta, gamma) to the local ones of a point: 2 (n . w) n - w, the same for either sign
/// of n. No normals: those of the world.
inline std::array<float, 2> to_local(std::span<const std::array<float, 3>> normals,
                                     std::size_t point, const std::array<float, 2>& world) {
  if (normals.empty()) return world;
  return direction_of(mirrored(normals[point], vector_of(world)));
}

}  // namespace slf
