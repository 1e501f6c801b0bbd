// SPDX-License-Identifier: Apache-2.0
// The part of a capture that is wanted, and points that are far away from all others.
#pragma once

#include <array>
#include <span>
#include <string>

#include "slf/capture.h"

namespace slf {

/// Keeps the points in a box, of a mesh the triangles whose centroids are in it.
/// @param origin  world, of the mesh's vertices
/// @errors kInvalidInput: nothing is in the box.
Result<Done, InputError> crop(Mesh& mesh, const Vec3& origin, const WorldBox& box);

/// What to say of a cloud that few points far away make several times as wide as it is, with a
/// box for crop(): a grid spans all points, so the others would share few of its cells. Empty of
/// any other cloud. O(P).
std::string far_points_warning(const PointCloud& cloud, const Vec3& origin);

/// The same of positions.
/// @param points, whole  what they are called, and all of them: "points", "the cloud"
std::string far_points_warning(std::span<const std::array<float, 3>> positions, const Vec3& origin,
                               const char* points, const char* whole);

}  // namespace slf
