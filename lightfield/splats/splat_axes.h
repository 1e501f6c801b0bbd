// SPDX-License-Identifier: Apache-2.0
// Axes of exported files.
#pragma once

#include <array>

#include "slf/splats.h"

namespace slf {

using AxisRows = std::array<Vec3, 3>;

/// Rows: the axes of the file in world axes, with the header's up where the file wants it.
AxisRows axis_rows(const LightFieldHeader& header, SplatAxes axes);

/// A world vector in the axes of the file.
inline Vec3 turned(const AxisRows& rows, const Vec3& v) {
  Vec3 out;
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = rows[i][0] * v[0] + rows[i][1] * v[1] + rows[i][2] * v[2];
  return out;
}

/// And back.
inline Vec3 turned_back(const AxisRows& rows, const Vec3& v) {
  Vec3 out;
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = rows[0][i] * v[0] + rows[1][i] * v[1] + rows[2][i] * v[2];
  return out;
}

/// Unit quaternion w, x, y, z that turns (0, 0, 1) onto the line of a unit normal, by 90 degrees at
/// most, so that w is sqrt(1/2) or more. Identity where the normal is 0.
std::array<float, 4> disc_rotation(const std::array<float, 3>& normal);

}  // namespace slf
