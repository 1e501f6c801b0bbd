// SPDX-License-Identifier: Apache-2.0
// Splats in other axes: what is turned of them, harmonics too.
#pragma once

#include <vector>

#include "lightfield/splats/splat_axes.h"
#include "slf/gaussians.h"

namespace slf {

/// How coefficients of harmonics change when what they describe is turned.
class HarmonicTurn {
 public:
  /// @param rows    orthonormal: the new coordinates of a vector are turned(rows, v)
  /// @param degree  0 .. 4
  HarmonicTurn(const AxisRows& rows, int degree);

  /// @param coefficients  [(degree + 1)^2][3]
  void apply(float* coefficients) const;

 private:
  std::vector<std::vector<double>> matrices_;  // of degrees 1 .. , row by row
};

/// Turns and scales splats about where they are from: v becomes scale * turned(rows, v). Rows may
/// mirror, too.
void move_gaussians(Gaussians& gaussians, const AxisRows& rows, double scale);

/// The longest side of the box of all places; 0: there are none.
double extent_of(const Gaussians& gaussians);

/// Moves all: their positions, or the origin where it is not 0, or floats would lose digits.
void shift_gaussians(Gaussians& gaussians, const Vec3& by);

/// In the axes that a file wants: y up or y down. Splats without a known axis count as y down,
/// which is the convention of files that do not say.
Gaussians in_axes(Gaussians gaussians, SplatAxes axes);

}  // namespace slf
