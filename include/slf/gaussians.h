// SPDX-License-Identifier: Apache-2.0
// Gaussian splats as they are trained: points with a view map, a shape and an opacity.
// Kerbl, Kopanas, Leimkuehler, Drettakis, "3D Gaussian splatting for real-time radiance field
// rendering" (2023).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "slf/error.h"
#include "slf/types.h"

namespace slf {

/// Values before their activations, as 3DGS's PLY has them. All are finite; vectors but `harmonics`
/// have one entry a splat.
struct Gaussians {
  int degree = 0;                ///< of the harmonics, 0 .. 4
  UpAxis up = UpAxis::kUnknown;  ///< of the file's axes, which are right-handed
  /// World; positions are from it. Not 0 where floats would lose digits, as of captures that are
  /// georeferenced. It has the axes of the positions.
  Vec3 origin{0, 0, 0};
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<float, 3>> log_deviations;  ///< natural logarithms, axis by axis
  std::vector<std::array<float, 4>> rotations;       ///< unit quaternions w, x, y, z: axes to world
  std::vector<float> logits;                         ///< opacity = 1 / (1 + exp(-logit))
  /// [P][(degree + 1)^2][3] coefficients of real harmonics, orthonormal over the sphere, with
  /// 3DGS's signs: colour = 0.5 + sum, 1 = display white, along the unit vector from eye to splat.
  std::vector<float> harmonics;

  std::size_t size() const { return positions.size(); }
  std::size_t num_harmonics() const { return std::size_t(degree + 1) * std::size_t(degree + 1); }
};

/// Splats that a program made: a degree of 0 to 4, vectors that go together, finite values, unit
/// quaternions. O(P K).
/// @errors kInvalidInput: names the vector, and the splat
Result<Done, InputError> check_gaussians(const Gaussians& gaussians);

/// Beyond these a logit, and a value of a shape (6.8), mean the bound.
inline constexpr double kLogitBound = 32, kShapeBound = 64;

/// Has every point a shape, an opacity and harmonics of degree 4 at most, in world axes?
bool has_gaussians(const LightFieldHeader& header);

/// A splat for every point, in point order. Where floats would lose digits of the world, `origin`
/// is the middle of the grid: the same for all frames of a file.
/// @errors kInvalidInput: has_gaussians() is not true, or coordinates beyond 1e15. O(P K). The same
/// for any thread count.
Result<Gaussians, InputError> gaussians_of(const LightField& field, int threads = 0);

/// Leaves out harmonics above a degree, 0 or more. O(P).
void keep_degree(Gaussians& gaussians, int degree);

}  // namespace slf
