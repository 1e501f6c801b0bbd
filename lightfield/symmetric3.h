// SPDX-License-Identifier: Apache-2.0
// Symmetric 3 x 3 matrices: as six values that are coded, and as axes with a value each.
#pragma once

#include <array>

#include "base/quaternion.h"

namespace slf {

/// xx, yy, zz, xy, xz, yz
using Symmetric3 = std::array<double, 6>;

/// Spec 6.8: an orthonormal change of coordinates, so that equal errors of the six values are equal
/// errors of the matrix; the first is its size, and the others of a ball are 0.
Symmetric3 from_shape_values(const std::array<double, 6>& values);
std::array<double, 6> shape_values(const Symmetric3& matrix);

/// Columns of `axis` are unit vectors, right-handed; value[i] belongs to column i.
struct Axes3 {
  Matrix3x3 axis;
  std::array<double, 3> value;
};

/// By Jacobi's rotations; exact to rounding. Finite for finite matrices.
Axes3 eigen_axes(const Symmetric3& matrix);
/// The sum of value times axis times its transpose.
Symmetric3 matrix_of(const Axes3& axes);

}  // namespace slf
