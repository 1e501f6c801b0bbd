// SPDX-License-Identifier: Apache-2.0
// The radiance conformance point: colour of a point along a direction.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "slf/error.h"
#include "slf/types.h"

namespace slf {

/// (θ, γ) of a direction given as a vector, any length > 0. Spec 6.4.
std::array<float, 2> direction_of(const Vec3& v);

/// Value of basis function k at (θ, γ), in double. Spec 6.3, the plain definition.
double basis_value(const Basis& basis, int k, double theta, double gamma);
/// Norm of function k over the sphere with mean square 1 for the constant: sqrt(mean of b_k^2).
/// [K]. Spec 6.3; quantiser steps of the default preset are proportional to its inverse.
std::vector<double> basis_norms(const Basis& basis);

/// The 3 x 3 matrix that takes coded channels to R, G, B. Spec 6.5. Its transpose goes back.
std::array<std::array<double, 3>, 3> colour_matrix(ColourTransform transform);

/// [P] The mean of every point over all directions (the DC), R, G, B, 0 .. 255. Needs no more than
/// the components that have a part in it. The light field must have a basis.
std::vector<std::array<float, 3>> mean_colours(const LightField& light_field, int threads = 0);

class FunctionTable;
class Harmonics;

/// View maps ready to be looked at, in R, G, B: the weights of the R coded functions, which are
/// looked up in a table over direction; or, for B-splines of order o that no transform codes, the
/// coefficients of periodic B-splines of order o on a 2^s0 x 2^s1 grid, so that one radiance takes
/// o * o fetches whatever K. Never changed once made: any number of threads may look up. Of
/// Gaussian splats (has_gaussians) they are the colours alone: slf/gaussian_renderer.h draws those.
class ViewMaps {
 public:
  /// Converts once; O(P R), with a joint transform O(P K R).
  /// @errors kInvalidArgument: the light field has no basis, another number of functions than its
  ///         basis, or another number of components than its points take
  static Result<ViewMaps, InputError> of(const LightField& light_field, int threads = 0);
  /// The same for a light field of which all this is known; others give colours without a meaning.
  explicit ViewMaps(const LightField& light_field, int threads = 0);
  /// Some points of a light field: their mirrors are given, since only all points tell them.
  /// @param mirror_normals  [P] unit normals of these points; empty: directions of the world
  ViewMaps(const LightField& some_points, std::vector<std::array<float, 3>> mirror_normals,
           int threads);

  /// R, G, B of point p, 0 .. num_points() - 1, seen along (θ, γ) (from the point to the eye), of
  /// the header's transfer. γ is first clamped to the header's range; the result to 0 .. 255.
  /// Agrees with the sum over the functions within 1/256 grey level, where they are looked up
  /// within 1/50.
  std::array<float, 3> radiance(std::size_t p, float theta, float gamma) const;
  /// The same of many points seen from a place in the world; quicker, and within 1/50 grey level.
  /// @param colours  [points] receives R, G, B
  void radiances(const Vec3& eye, std::span<const std::uint32_t> points,
                 std::span<std::array<float, 3>> colours) const;
  /// The same without any clamp.
  std::array<float, 3> radiance_unclamped(std::size_t p, float theta, float gamma) const;
  /// The colour of point p as mean_colours() has it.
  std::array<float, 3> mean(std::size_t p) const;

  const LightFieldHeader& header() const { return header_; }
  std::span<const Voxel> positions() const { return positions_; }
  const CodedNormals& normals() const { return normals_; }
  std::size_t num_points() const { return positions_.size(); }

 private:
  LightFieldHeader header_;
  std::vector<Voxel> positions_;
  CodedNormals normals_;
  std::array<float, 3> sum_of_functions(std::size_t p, const std::array<float, 2>& direction) const;
  std::array<float, 3> seen_from(std::size_t p, const Vec3& eye) const;

  std::size_t width_ = 0;     // K or R
  std::vector<float> nodes_;  // [P][2^s0][2^s1][3], or [P][3][R] weights of functions
  std::vector<std::array<float, 3>> mirror_normals_;  // [P], or empty: directions of the world
  std::shared_ptr<const Harmonics> harmonics_;        // where the functions are harmonics
  std::shared_ptr<const FunctionTable> table_;        // where they are sums
  std::vector<std::array<float, 3>> mean_;
};

}  // namespace slf
