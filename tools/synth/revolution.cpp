// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/revolution.h"

#include <limits>
#include <numbers>

namespace slf::synth {
namespace {

struct Across {
  double r, z;
};

Across unit_across(double r, double z) {
  const double scale = 1 / std::hypot(r, z);
  return {r * scale, z * scale};
}

/// Angle of the outward normal of a profile that runs along (r, z): the direction turned right.
double normal_angle(const Across& along) { return std::atan2(-along.r, along.z); }

/// An arc that replaces a corner.
struct Fillet {
  Across centre;
  double signed_radius;   // > 0 where the corner is convex
  double angle0, angle1;  // of the outward normal
};

Fillet round_corner(const ProfileCorner& before, const ProfileCorner& at,
                    const ProfileCorner& after) {
  const Across in = unit_across(at.r - before.r, at.z - before.z);
  const Across out = unit_across(after.r - at.r, after.z - at.z);
  const double turn = std::atan2(in.r * out.z - in.z * out.r, in.r * out.r + in.z * out.z);
  const double angle0 = normal_angle(in);
  const double reach = at.fillet / std::cos(turn / 2);  // corner to centre of the arc
  const double side = turn > 0 ? 1 : -1;                // left turns are convex
  const double middle = angle0 + turn / 2;
  return {{at.r - side * reach * std::cos(middle), at.z - side * reach * std::sin(middle)},
          side * at.fillet,
          angle0,
          angle0 + turn};
}

/// Enough frusta that an arc is within 0.0005 of its chords; normals are interpolated anyway.
int arc_segments(const Fillet& arc) {
  const double step = std::sqrt(8 * 0.0005 / std::max(std::abs(arc.signed_radius), 1e-6));
  return std::clamp(static_cast<int>(std::ceil(std::abs(arc.angle1 - arc.angle0) / step)), 2, 16);
}

}  // namespace

Revolution::Revolution(std::span<const ProfileCorner> corners) {
  double r = corners.front().r, z = corners.front().z;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const ProfileCorner& corner = corners[i];
    const Across along = unit_across(corner.r - corners[i - 1].r, corner.z - corners[i - 1].z);
    if (i + 1 == corners.size()) {
      add(r, z, corner.r, corner.z, normal_angle(along), normal_angle(along));
      break;
    }
    const Fillet arc = round_corner(corners[i - 1], corner, corners[i + 1]);
    const int segments = arc_segments(arc);
    const double step = (arc.angle1 - arc.angle0) / segments;
    for (int k = 0; k <= segments; ++k) {
      const double angle = arc.angle0 + step * k;
      const double next_r = arc.centre.r + arc.signed_radius * std::cos(angle);
      const double next_z = arc.centre.z + arc.signed_radius * std::sin(angle);
      add(r, z, next_r, next_z, k == 0 ? angle : angle - step, angle);
      r = next_r;
      z = next_z;
    }
  }
  if (widest_ >= 0 && frusta_[std::size_t(widest_)].r0 < radius_ - 1e-9) widest_ = -1;
}

void Revolution::add(double r0, double z0, double r1, double z1, double angle0, double angle1) {
  if (std::hypot(r1 - r0, z1 - z0) < 1e-9) return;
  if (frusta_.empty()) bottom_ = top_ = z0;
  const double slope = std::abs(z1 - z0) < 1e-9 ? 0 : (r1 - r0) / (z1 - z0);
  frusta_.push_back({r0, z0, r1, z1, slope, std::cos(angle0), std::sin(angle0), std::cos(angle1),
                     std::sin(angle1)});
  bottom_ = std::min({bottom_, z0, z1});
  top_ = std::max({top_, z0, z1});
  radius_ = std::max({radius_, r0, r1});
  const Frustum* widest_so_far = widest();
  const bool cylinder = std::abs(r1 - r0) < 1e-9 && angle0 == angle1 && r1 > radius_ - 1e-9;
  if (cylinder && (!widest_so_far || r1 > widest_so_far->r0 + 1e-9))
    widest_ = static_cast<int>(frusta_.size()) - 1;
}

SurfacePoint Revolution::surface_point(const Frustum& f, const Vec3& position) {
  const double r = std::sqrt(position[0] * position[0] + position[1] * position[1]);
  const double span_r = f.r1 - f.r0, span_z = f.z1 - f.z0;
  const double t =
      ((r - f.r0) * span_r + (position[2] - f.z0) * span_z) / (span_r * span_r + span_z * span_z);
  const double nr = f.nr0 + t * (f.nr1 - f.nr0), nz = f.nz0 + t * (f.nz1 - f.nz0);
  const double scale = 1 / std::sqrt(nr * nr + nz * nz);
  const double radial = r > 1e-12 ? nr * scale / r : 0;
  return {position, {radial * position[0], radial * position[1], nz * scale}};
}

template <class Visit>
void Revolution::visit_crossings(const Ray& ray, double z_low, double z_high, Visit&& visit) const {
  const auto& [ox, oy, oz] = ray.origin;
  const auto& [dx, dy, dz] = ray.direction;
  const double dxy = dx * dx + dy * dy, oxy = ox * ox + oy * oy, mixed = ox * dx + oy * dy;
  for (const Frustum& f : frusta_) {
    const double low = std::min(f.z0, f.z1), high = std::max(f.z0, f.z1);
    if (high < z_low || low > z_high) continue;
    if (high - low < 1e-9) {  // an annulus
      if (std::abs(dz) < 1e-12) continue;
      const double t = (f.z0 - oz) / dz;
      const double r2 = oxy + t * (2 * mixed + t * dxy);
      const double inner = std::min(f.r0, f.r1), outer = std::max(f.r0, f.r1);
      if (r2 >= inner * inner && r2 < outer * outer) visit(t, f);
      continue;
    }
    // x^2 + y^2 = (k + s z)^2 along the ray.
    const double at_origin = f.r0 + f.slope * (oz - f.z0), rate = f.slope * dz;
    const double a = dxy - rate * rate, b = mixed - at_origin * rate;
    const double c = oxy - at_origin * at_origin;
    if (std::abs(a) < 1e-14) continue;  // parallel to the cone: a set of measure zero
    const double discriminant = b * b - a * c;
    if (discriminant <= 0) continue;
    const double root = std::sqrt(discriminant);
    for (const double t : {(-b - root) / a, (-b + root) / a}) {
      const double z = oz + t * dz;  // half open, so that neighbours do not both report a seam
      if (z >= low && z < high && at_origin + t * rate >= 0) visit(t, f);
    }
  }
}

Mesh Revolution::mesh(std::uint32_t segments) const {
  Mesh mesh;
  for (const Frustum& f : frusta_) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.positions.size());
    for (std::uint32_t s = 0; s <= segments; ++s) {
      const double angle = 2 * std::numbers::pi * s / segments;
      const double c = std::cos(angle), n = std::sin(angle);
      const auto add = [&](double r, double z, double nr, double nz) {
        mesh.vertices.positions.push_back(
            {static_cast<float>(r * c), static_cast<float>(r * n), static_cast<float>(z)});
        mesh.vertices.normals.push_back(
            {static_cast<float>(nr * c), static_cast<float>(nr * n), static_cast<float>(nz)});
      };
      add(f.r0, f.z0, f.nr0, f.nz0);
      add(f.r1, f.z1, f.nr1, f.nz1);
    }
    for (std::uint32_t s = 0; s < segments; ++s) {
      const std::uint32_t a = first + 2 * s;  // a + 1 is above it, a + 2 beside it
      mesh.triangles.push_back({a, a + 2, a + 3});
      mesh.triangles.push_back({a, a + 3, a + 1});
    }
  }
  return mesh;
}

void Revolution::crossings(const Ray& ray, std::vector<SurfacePoint>& out) const {
  visit_crossings(ray, bottom_, top_,
                  [&](double t, const Frustum& f) { out.push_back(surface_point(f, ray.at(t))); });
}

std::optional<SurfacePoint> Revolution::nearest(const Ray& ray) const {
  const auto& [ox, oy, oz] = ray.origin;
  const auto& [dx, dy, dz] = ray.direction;
  // Where the ray is inside the bounding cylinder.
  const double a = dx * dx + dy * dy, b = ox * dx + oy * dy,
               c = ox * ox + oy * oy - radius_ * radius_;
  const double discriminant = b * b - a * c;
  if (discriminant <= 0 || a < 1e-14) return std::nullopt;
  const double root = std::sqrt(discriminant);
  const double enter = (-b - root) / a, leave = (-b + root) / a;
  const double z_enter = oz + enter * dz, z_leave = oz + leave * dz;
  if (const Frustum* body = widest();
      body && enter > 0 && z_enter >= body->z0 && z_enter < body->z1)
    return surface_point(*body, ray.at(enter));  // nothing sticks out further
  double first = std::numeric_limits<double>::infinity();
  const Frustum* hit = nullptr;
  visit_crossings(ray, std::min(z_enter, z_leave), std::max(z_enter, z_leave),
                  [&](double t, const Frustum& f) {
                    if (t <= 0 || t >= first) return;
                    first = t;
                    hit = &f;
                  });
  if (!hit) return std::nullopt;
  return surface_point(*hit, ray.at(first));
}

}  // namespace slf::synth
