// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/moving_part.h"

#include <numbers>

namespace slf::synth {
namespace {

Vec3 vec_of(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

std::array<float, 3> floats_of(const Vec3& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

/// Two unit vectors across a third, each across the other, right-handed with it last.
std::array<Vec3, 2> across(const Vec3& normal) {
  const Vec3 other = std::abs(normal[2]) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0};
  const Vec3 first = normalised(cross(other, normal));
  return {first, cross(normal, first)};
}

struct Corner {
  Vec3 position, normal;
};

std::array<Corner, 3> corners_of(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  std::array<Corner, 3> corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = {vec_of(mesh.vertices.positions[triangle[k]]),
                  vec_of(mesh.vertices.normals[triangle[k]])};
  return corners;
}

double area_between(const std::array<Corner, 3>& c) {
  return length(cross(c[1].position - c[0].position, c[2].position - c[0].position)) / 2;
}

/// The corner across from the shortest side.
std::size_t tip_of(const std::array<Corner, 3>& c) {
  std::size_t tip = 0;
  const auto side = [&](std::size_t k) {
    return length(c[(k + 2) % 3].position - c[(k + 1) % 3].position);
  };
  for (std::size_t k = 1; k < 3; ++k)
    if (side(k) < side(tip)) tip = k;
  return tip;
}

/// Candidates are in rows across the two longer sides, from the tip where they meet. One is a
/// point whenever the area since the last has grown to that of a point; `owed` goes on from
/// triangle to triangle.
void sample_triangle(const std::array<Corner, 3>& c, double spacing, double& owed,
                     std::vector<SurfacePoint>& out) {
  const std::size_t tip = tip_of(c);
  const Corner &top = c[tip], &left = c[(tip + 1) % 3], &right = c[(tip + 2) % 3];
  const double base = length(right.position - left.position);
  const double height = length(mix(left.position, right.position, 0.5) - top.position);
  const int rows = std::max(1, static_cast<int>(std::ceil(height / spacing)));
  const double points = area_between(c) / (spacing * spacing);
  for (int row = 0; row < rows; ++row) {
    const double down = (row + 0.5) / rows;
    const int columns = std::max(1, static_cast<int>(std::ceil(down * base / spacing)));
    // A row is a trapezium: its share of the area is 2 down / rows.
    const double each = points * 2 * down / rows / columns;
    for (int column = 0; column < columns; ++column) {
      owed += each;
      if (owed < 1) continue;
      owed -= 1;
      const double along = (column + 0.5) / columns;
      out.push_back({mix(top.position, mix(left.position, right.position, along), down),
                     normalised(mix(top.normal, mix(left.normal, right.normal, along), down))});
    }
  }
}

}  // namespace

SurfacePoint placed(const MovingPart& part, const SurfacePoint& at_rest, double time) {
  constexpr double kStep = 1e-5;  // of a derivative; scenes are about 1 across
  const Vec3 at = part.place(at_rest.position, time);
  const auto [u, v] = across(at_rest.normal);
  const Vec3 du = part.place(at_rest.position + kStep * u, time) - at;
  const Vec3 dv = part.place(at_rest.position + kStep * v, time) - at;
  return {at, normalised(cross(du, dv))};
}

std::vector<SurfacePoint> sample_mesh(const Mesh& mesh, double spacing) {
  std::vector<SurfacePoint> points;
  double owed = 0.5;  // so that rounding has no side
  for (const auto& triangle : mesh.triangles)
    sample_triangle(corners_of(mesh, triangle), spacing, owed, points);
  return points;
}

double area_of(const Mesh& mesh) {
  double area = 0;
  for (const auto& triangle : mesh.triangles) area += area_between(corners_of(mesh, triangle));
  return area;
}

Mesh split_long(Mesh mesh, double longest) {
  // Triangles that a split adds are looked at in their turn. Neighbours may be split otherwise:
  // the new corner is on their common side, so there is no gap.
  for (std::size_t t = 0; t < mesh.triangles.size();) {
    const auto triangle = mesh.triangles[t];
    const auto c = corners_of(mesh, triangle);
    std::size_t worst = 0;  // the side from this corner to the next
    const auto side = [&](std::size_t k) {
      return length(c[(k + 1) % 3].position - c[k].position);
    };
    for (std::size_t k = 1; k < 3; ++k)
      if (side(k) > side(worst)) worst = k;
    if (side(worst) <= longest) {
      ++t;
      continue;
    }
    const std::size_t next = (worst + 1) % 3;
    const auto middle = static_cast<std::uint32_t>(mesh.vertices.positions.size());
    mesh.vertices.positions.push_back(floats_of(mix(c[worst].position, c[next].position, 0.5)));
    mesh.vertices.normals.push_back(
        floats_of(normalised(mix(c[worst].normal, c[next].normal, 0.5))));
    mesh.triangles[t][next] = middle;
    mesh.triangles.push_back(triangle);
    mesh.triangles.back()[worst] = middle;
  }
  return mesh;
}

Mesh grid_mesh(std::uint32_t around, std::uint32_t along,
               const std::function<Vec3(double, double)>& surface) {
  Mesh mesh;
  std::vector<Vec3> places, normals(std::size_t(around) * (along + 1), Vec3{0, 0, 0});
  for (std::uint32_t row = 0; row <= along; ++row)
    for (std::uint32_t column = 0; column < around; ++column) {
      places.push_back(surface(double(column) / around, double(row) / along));
      mesh.vertices.positions.push_back(floats_of(places.back()));
    }
  const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Vec3 normal = cross(places[b] - places[a], places[c] - places[a]);
    if (length(normal) < 1e-12) return;  // at an end
    mesh.triangles.push_back({a, b, c});
    for (const std::uint32_t corner : {a, b, c}) normals[corner] = normals[corner] + normal;
  };
  for (std::uint32_t row = 0; row < along; ++row)
    for (std::uint32_t column = 0; column < around; ++column) {
      const std::uint32_t next = (column + 1) % around, low = row * around, high = low + around;
      triangle(low + column, low + next, high + next);
      triangle(low + column, high + next, high + column);
    }
  // The corners of an end are one point.
  for (const std::size_t row : {std::size_t{0}, std::size_t{along}}) {
    Vec3 sum{0, 0, 0};
    for (std::size_t i = 0; i < around; ++i) sum = sum + normals[row * around + i];
    for (std::size_t i = 0; i < around; ++i) normals[row * around + i] = sum;
  }
  for (const Vec3& normal : normals) mesh.vertices.normals.push_back(floats_of(normalised(normal)));
  return mesh;
}

Mesh capsule_mesh(const Capsule& capsule) {
  const Vec3 axis = capsule.b - capsule.a;
  const Vec3 up = length(axis) > 1e-9 ? normalised(axis) : Vec3{0, 0, 1};
  const auto sides = across(up);
  const auto& x = std::get<0>(sides);
  const auto& y = std::get<1>(sides);
  return grid_mesh(48, 33, [&](double around, double along) {
    // Rows go over one end, then the other: the straight side is between the two middle ones.
    const double row = along * 33;
    const double angle = std::numbers::pi * ((row < 16.5 ? row : row - 1) / 32 - 0.5);
    const double turn = 2 * std::numbers::pi * around;
    const Vec3 out = std::cos(angle) * (std::cos(turn) * x + std::sin(turn) * y);
    return (row < 16.5 ? capsule.a : capsule.b) + capsule.radius * (out + std::sin(angle) * up);
  });
}

Vec3 turned(const Vec3& v, const Vec3& axis, double angle) {  // Rodrigues
  return std::cos(angle) * v + std::sin(angle) * cross(axis, v) +
         ((1 - std::cos(angle)) * dot(axis, v)) * axis;
}

}  // namespace slf::synth
