// SPDX-License-Identifier: Apache-2.0
// A closed surface that is where it is as a function of time: a mesh at rest, and how it is bent.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "slf/capture.h"
#include "tools/synth/shading.h"
#include "tools/synth/vec.h"

namespace slf::synth {

/// All points within `radius` of the segment from a to b; a ball where they are one point.
struct Capsule {
  Vec3 a, b;
  double radius;
};

struct MovingPart {
  Mesh rest;  ///< with normals; its places are what colours hang on
  std::function<Colour(const SurfacePoint& at_rest)> albedo;
  Material material;
  /// Where a point at rest is at a time, in frames since the first; smooth in its first argument.
  std::function<Vec3(const Vec3& at_rest, double time)> place;
  int first_frame = 0;                ///< it is not there before
  std::optional<Capsule> solid = {};  ///< at rest, where the part is one: samples of others that
                                      ///< lie in it are left out
};

/// The point at a time, with the normal of the bent surface.
SurfacePoint placed(const MovingPart& part, const SurfacePoint& at_rest, double time);

/// Points of the mesh, evenly, one in a square of `spacing` on average. Normals are interpolated.
/// O(triangles + points).
std::vector<SurfacePoint> sample_mesh(const Mesh& mesh, double spacing);
double area_of(const Mesh& mesh);

/// A closed surface (around, along) -> place, both 0 .. 1, that meets itself in `around` and ends
/// in a point at both ends of `along`. Normals are means of the triangles'.
Mesh grid_mesh(std::uint32_t around, std::uint32_t along,
               const std::function<Vec3(double around, double along)>& surface);
/// No side of a triangle is longer, the surface is the same: long thin ones are slow to trace.
Mesh split_long(Mesh mesh, double longest);
Mesh capsule_mesh(const Capsule& capsule);

/// Turned about an axis (unit) through the origin, counter-clockwise seen from its tip, radians.
Vec3 turned(const Vec3& v, const Vec3& axis, double angle);

}  // namespace slf::synth
