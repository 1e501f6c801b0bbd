// SPDX-License-Identifier: Apache-2.0
// Arithmetic on Vec3, for the analytic scenes.
#pragma once

#include <algorithm>
#include <cmath>

#include "slf/types.h"

namespace slf::synth {

using Colour = Vec3;  ///< linear light, 1 = display white

inline Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vec3 operator*(double s, const Vec3& a) { return {s * a[0], s * a[1], s * a[2]}; }
/// Component by component: light on a coloured surface.
inline Vec3 operator*(const Vec3& a, const Vec3& b) {
  return {a[0] * b[0], a[1] * b[1], a[2] * b[2]};
}
inline double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Vec3& a) { return std::sqrt(dot(a, a)); }
inline Vec3 normalised(const Vec3& a) { return (1 / length(a)) * a; }
inline Vec3 mix(const Vec3& a, const Vec3& b, double t) { return (1 - t) * a + t * b; }

inline double smoothstep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

struct Ray {
  Vec3 origin;
  Vec3 direction;  ///< unit
  Vec3 at(double t) const { return origin + t * direction; }
};

struct SurfacePoint {
  Vec3 position;
  Vec3 normal;  ///< unit, outward
};

}  // namespace slf::synth
