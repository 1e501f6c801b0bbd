// SPDX-License-Identifier: Apache-2.0
// The fit to pictures as linear algebra.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "encoder/fit/direction_kernel.h"
#include "encoder/fit/direction_rows.h"
#include "encoder/fit/picture_views.h"
#include "slf/fit.h"
#include "slf/types.h"

namespace slf {

/// The error over a set of pixels.
struct PictureError {
  double squares = 0;  ///< trusted squared errors of all channels
  double trust = 0;    ///< of pixels
  double psnr() const;

  PictureError& operator+=(const PictureError& other) {
    squares += other.squares;
    trust += other.trust;
    return *this;
  }
};

/// Minimises, over changes e of the coefficients,
///     sum over pixels trust |r - W B e|^2 + sum_k penalty_k |e_k|^2
/// with W the weights of the renderer and B the functions along the rays. The minimum is e = P^-1
/// B^T z, one z a ray, so that its conjugate gradients need no coefficients: with G = B P^-1 B^T,
/// which has a small block per point,
///     (1 + W^T T W G) z = W^T T r,
/// symmetric in the inner product of G. Vectors are [rays]. Results are the same for any thread
/// count.
class PictureSystem {
 public:
  using Vector = std::vector<std::array<float, 3>>;  ///< R, G, B of each ray

  /// @param eyes  [views] the cameras' centres, world
  /// @param gamma_range  of directions, as the file will clamp them
  /// All kept by reference but eyes.
  PictureSystem(const Grid& grid, std::span<const Voxel> positions, const FitSettings& settings,
                std::array<float, 2> gamma_range, PictureViews& pictures, std::vector<Vec3> eyes);

  /// Multiplies all penalties, 1 at first.
  void set_pull(double pull) { pull_ = static_cast<float>(pull); }

  /// B c: colours along the rays, not clamped.
  Vector colours(std::span<const float> coefficients) const;
  /// c += P^-1 B^T z.
  void add(const Vector& z, std::span<float> coefficients) const;

  /// Sets every pixel's trust by how far it is off with these colours; 1 / (1 + (off /
  /// outlier)^2)^2.
  void set_trust(const Vector& colours, double outlier);
  /// Trusted error of each view.
  std::vector<PictureError> errors(const Vector& colours) const;
  /// The same of the differences between pictures of two sets of colours.
  std::vector<PictureError> changes(const Vector& from, const Vector& to) const;

  /// Colours changed by `steps` of conjugate gradients on the views that `used` tells.
  /// @param z  is added to; or null
  void improve(const std::function<bool(std::size_t view)>& used, int steps, Vector& colours,
               Vector* z) const;

 private:
  Vec3 towards(std::size_t point, std::size_t ray) const;
  Vec3 direction(std::size_t point, std::size_t ray) const;
  std::vector<float> rows_of(std::size_t point, std::size_t from, std::size_t to) const;
  void apply_kernel(const Vector& x, Vector& out) const;
  void add_pictures(const std::vector<bool>& used, const Vector& x, Vector& out) const;
  Vector residual(const std::vector<bool>& used, const Vector& colours) const;
  template <class Body>
  void each_point(const Body& body) const;

  const Grid& grid_;
  std::span<const Voxel> positions_;
  PictureViews& pictures_;
  std::vector<Vec3> eyes_;
  std::array<float, 2> gamma_range_;
  int threads_;
  DirectionRows rows_;
  std::vector<double> penalty_;  // [K]
  float pull_ = 1;
  DirectionKernel kernel_;
  std::vector<std::array<float, 3>> normals_;  // that directions are mirrored at
  std::vector<std::array<float, 3>> world_;    // [rays] unit, to the eyes
};

}  // namespace slf
