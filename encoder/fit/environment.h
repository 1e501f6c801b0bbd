// SPDX-License-Identifier: Apache-2.0
// What is reflected: light on a sphere about the object, at a finite distance.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "slf/fit.h"
#include "slf/types.h"

namespace slf {

inline constexpr int kMaxEnvironmentDegree = 16;
/// Half the diagonal of a cube is sqrt 3 of half its side.
inline constexpr double kLeastEnvironmentRadius = 2;

/// The box of the points, its centre at the origin, half its longest side 1.
class ObjectBox {
 public:
  /// @param positions  at least one
  explicit ObjectBox(std::span<const Voxel> positions);
  /// half: > 0
  ObjectBox(const Vec3& centre, double half) : centre_(centre), half_(half) {}

  const Vec3& centre() const { return centre_; }
  double half() const { return half_; }
  Vec3 operator()(const Voxel& voxel) const;

 private:
  Vec3 centre_{};
  double half_ = 1;
};

/// Where a ray from `position`, inside a sphere of this radius about the origin, meets it; over the
/// radius. Parallel rays from two points meet it at two places: parallax.
Vec3 place_on_sphere(const Vec3& position, const Vec3& direction, double radius);

/// Light by place, of harmonics of high degree, tabulated. Thread-safe once made.
class Environment {
 public:
  /// @param light  [(degree + 1)^2][3], element 0 is not used
  Environment(double radius, int degree, std::span<const float> light, int threads);

  /// What a mirror at `position` in the box shows along `reflected`, less a constant. Within 0.2 %
  /// of the greatest for degree 16.
  std::array<float, 3> operator()(const Vec3& position, const Vec3& reflected) const;

  double radius() const { return radius_; }

 private:
  double radius_;
  std::vector<std::array<float, 4>> table_;  // [6][kSide + 1][kSide + 1] on the faces of a cube
};

}  // namespace slf
