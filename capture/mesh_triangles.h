// SPDX-License-Identifier: Apache-2.0
// Triangles of a mesh one by one: corners, normals, and what follows from all of them.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "base/vec3.h"
#include "capture/voxelise.h"
#include "slf/capture.h"

namespace slf {

using Corners = std::array<Vec3, 3>;

/// Unit; nothing for a vector without a direction.
inline std::optional<Vec3> unit_vector(const Vec3& v) {
  const double length = std::sqrt(dot(v, v));
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  return Vec3{v[0] / length, v[1] / length, v[2] / length};
}

inline std::optional<Vec3> normal_of(const Corners& c) {
  return unit_vector(cross(minus(c[1], c[0]), minus(c[2], c[0])));
}

Corners corners_of(const Mesh& mesh, std::size_t triangle);

/// Box of the vertices that triangles have; of all where there are no triangles.
Box bounding_box(const Mesh& mesh);

/// Area of the triangles' projections along the axes they look along: over the square of a step,
/// the number of points that it takes, nearly.
double sampled_area(const Mesh& mesh);

/// Middles of up to `count` triangles, spread evenly over the list, with the faces' normals: for
/// measuring where a mesh is before it is sampled.
PointCloud triangle_centres(const Mesh& mesh, std::size_t count);

}  // namespace slf
