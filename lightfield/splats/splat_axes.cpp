// SPDX-License-Identifier: Apache-2.0
#include "lightfield/splats/splat_axes.h"

#include <cmath>

#include "base/vec3.h"

namespace slf {
namespace {

Vec3 negated(const Vec3& v) { return {-v[0], -v[1], -v[2]}; }

/// Where up is in a right-handed world; an unknown axis counts as +y, so that nothing is turned.
Vec3 up_vector(UpAxis up) {
  if (up == UpAxis::kUnknown) return {0, 1, 0};
  const auto code = static_cast<std::size_t>(up);
  Vec3 v{0, 0, 0};
  v[code / 2] = code % 2 == 0 ? 1 : -1;
  return v;
}

}  // namespace

AxisRows axis_rows(const LightFieldHeader& header, SplatAxes axes) {
  AxisRows rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  if (axes != SplatAxes::kWorld) {
    const Vec3 up = up_vector(header.up);
    const Vec3 right = up[0] != 0 ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    rows = {right, up, cross(right, up)};
    if (axes == SplatAxes::kYDown) rows = {right, negated(up), negated(cross(right, up))};
  }
  if (!header.right_handed) rows[0] = negated(rows[0]);
  return rows;
}

std::array<float, 4> disc_rotation(const std::array<float, 3>& normal) {
  const float sign = normal[2] < 0 ? -1.0f : 1.0f;
  const float x = sign * normal[0], y = sign * normal[1], z = sign * normal[2];
  if (!(x != 0 || y != 0 || z != 0)) return {1, 0, 0, 0};
  // Half way between the two: (1 + cos, axis * sin), normalised.
  const float length = std::sqrt((1 + z) * (1 + z) + x * x + y * y);
  return {(1 + z) / length, -y / length, x / length, 0};
}

}  // namespace slf
