// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/solid.h"

#include <limits>

namespace slf::synth {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

Vec3 unit_vector(std::size_t axis, double sign) {
  Vec3 n{0, 0, 0};
  n[axis] = sign;
  return n;
}

/// Cuts what lies between low and high along an axis out of the chord; false: nothing is left.
bool cut_slab(Chord& c, const Probe& line, std::size_t axis, double low, double high) {
  const double origin = line.origin[axis];
  if (line.direction[axis] == 0) return origin >= low && origin < high;
  const double sign = line.direction[axis] > 0 ? 1 : -1;
  const double a = (low - origin) * line.inverse[axis], b = (high - origin) * line.inverse[axis];
  const double enter = std::min(a, b), leave = std::max(a, b);
  if (enter > c.enter) {
    c.enter = enter;
    c.enter_normal = unit_vector(axis, -sign);
  }
  if (leave < c.leave) {
    c.leave = leave;
    c.leave_normal = unit_vector(axis, sign);
  }
  return c.enter < c.leave;
}

/// Cuts away what is outside of dot(normal, x) <= offset.
bool cut_plane(Chord& c, const Probe& line, const Vec3& normal, double offset) {
  const double fall = dot(normal, line.direction), above = dot(normal, line.origin) - offset;
  if (fall == 0) return above < 0;
  const double at = -above / fall;
  if (fall < 0 && at > c.enter) {
    c.enter = at;
    c.enter_normal = normal;
  }
  if (fall > 0 && at < c.leave) {
    c.leave = at;
    c.leave_normal = normal;
  }
  return c.enter < c.leave;
}

/// The ball, or the round side of the cylinder: its first `dimensions` axes.
bool cut_round(Chord& c, const Probe& line, const Solid& solid, std::size_t dimensions) {
  const double radius = (solid.high[0] - solid.low[0]) / 2;
  double a = 0, b = 0, rest = -radius * radius;
  Vec3 from{0, 0, 0};
  for (std::size_t k = 0; k < dimensions; ++k) {
    from[k] = line.origin[k] - (solid.low[k] + solid.high[k]) / 2;
    a += line.direction[k] * line.direction[k];
    b += line.direction[k] * from[k];
    rest += from[k] * from[k];
  }
  if (a == 0) return rest < 0;
  const double root = b * b - a * rest;
  if (root <= 0) return false;
  const auto normal = [&](double t) {
    Vec3 n{0, 0, 0};
    for (std::size_t k = 0; k < dimensions; ++k) n[k] = (from[k] + t * line.direction[k]) / radius;
    return n;
  };
  const double enter = (-b - std::sqrt(root)) / a, leave = (-b + std::sqrt(root)) / a;
  if (enter > c.enter) {
    c.enter = enter;
    c.enter_normal = normal(enter);
  }
  if (leave < c.leave) {
    c.leave = leave;
    c.leave_normal = normal(leave);
  }
  return c.enter < c.leave;
}

struct Slopes {
  double across, up;  ///< of the unit normals (0, -across, up) and (0, across, up)
  double middle;      ///< y of the ridge
};

Slopes slopes_of(const Solid& roof) {
  const double half = (roof.high[1] - roof.low[1]) / 2, height = roof.high[2] - roof.low[2];
  const double norm = std::sqrt(half * half + height * height);
  return {height / norm, half / norm, (roof.low[1] + roof.high[1]) / 2};
}

bool cut_roof(Chord& c, const Probe& line, const Solid& roof) {
  const Slopes s = slopes_of(roof);
  for (const double side : {-1.0, 1.0}) {
    const Vec3 normal{0, side * s.across, s.up};
    if (!cut_plane(c, line, normal, dot(normal, Vec3{0, s.middle, roof.high[2]}))) return false;
  }
  return cut_slab(c, line, 0, roof.low[0], roof.high[0]);
}

}  // namespace

std::optional<Chord> chord(const Solid& solid, const Probe& line) {
  Chord c{-kFar, kFar, {}, {}};
  bool inside = true;
  switch (solid.shape) {
    case Shape::kBox:
      for (std::size_t k = 0; inside && k < 3; ++k)
        inside = cut_slab(c, line, k, solid.low[k], solid.high[k]);
      break;
    case Shape::kSphere:
      inside = cut_round(c, line, solid, 3);
      break;
    case Shape::kCylinder:
      inside = cut_round(c, line, solid, 2) && cut_slab(c, line, 2, solid.low[2], solid.high[2]);
      break;
    case Shape::kRoof:
      inside = cut_slab(c, line, 2, solid.low[2], solid.high[2]) && cut_roof(c, line, solid);
      break;
  }
  if (!inside) return std::nullopt;
  return c;
}

bool contains(const Solid& solid, const Vec3& p) {
  for (std::size_t k = 0; k < 3; ++k)
    if (p[k] < solid.low[k] || p[k] >= solid.high[k]) return false;
  if (solid.shape == Shape::kBox) return true;
  if (solid.shape == Shape::kRoof) {
    const Slopes s = slopes_of(solid);
    return std::abs(p[1] - s.middle) * s.across + (p[2] - solid.high[2]) * s.up < 0;
  }
  const double radius = (solid.high[0] - solid.low[0]) / 2;
  double squares = 0;
  for (std::size_t k = 0; k < (solid.shape == Shape::kSphere ? 3u : 2u); ++k) {
    const double d = p[k] - (solid.low[k] + solid.high[k]) / 2;
    squares += d * d;
  }
  return squares < radius * radius;
}

}  // namespace slf::synth
