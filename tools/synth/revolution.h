// SPDX-License-Identifier: Apache-2.0
// A closed surface of revolution around the z axis, given by a polyline with rounded corners.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "slf/capture.h"
#include "tools/synth/vec.h"

namespace slf::synth {

/// A corner of the profile. The profile runs from the axis at the bottom, outward and up, back to
/// the axis at the top, so that the outside lies to its right. Fillets must leave something of the
/// straight pieces between them.
struct ProfileCorner {
  double r, z;
  double fillet;  ///< radius of the rounding, 0 at the two ends
};

class Revolution {
 public:
  explicit Revolution(std::span<const ProfileCorner> corners);

  double radius() const { return radius_; }
  double bottom() const { return bottom_; }
  double top() const { return top_; }

  /// Triangles with the surface's own normals at their corners.
  /// @param segments  of a circle
  Mesh mesh(std::uint32_t segments) const;

  void crossings(const Ray& ray, std::vector<SurfacePoint>& out) const;
  /// The first crossing in front of the ray's origin, which must be outside.
  std::optional<SurfacePoint> nearest(const Ray& ray) const;

 private:
  /// A cone frustum (or annulus where z0 = z1). The normal is interpolated between its ends, as the
  /// arcs that frusta stand for have it.
  struct Frustum {
    double r0, z0, r1, z1;
    double slope;  // dr / dz
    double nr0, nz0, nr1, nz1;
  };
  template <class Visit>
  void visit_crossings(const Ray& ray, double z_low, double z_high, Visit&& visit) const;
  static SurfacePoint surface_point(const Frustum& frustum, const Vec3& position);
  void add(double r0, double z0, double r1, double z1, double angle0, double angle1);

  std::vector<Frustum> frusta_;
  double radius_ = 0, bottom_ = 0, top_ = 0;
  const Frustum* widest() const { return widest_ < 0 ? nullptr : &frusta_[std::size_t(widest_)]; }
  int widest_ = -1;  // the cylinder of the largest radius: what most rays hit first
};

}  // namespace slf::synth
