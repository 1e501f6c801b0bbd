// SPDX-License-Identifier: Apache-2.0
// Attributes of a splat as real numbers. Spec 6.8.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lightfield/symmetric3.h"
#include "slf/types.h"

namespace slf {

/// The first function of an attribute; num_functions where it is not there.
int first_function(const LightFieldHeader& header, AttributeId id);

/// Where a splat's attributes begin.
struct SplatFunctions {
  int opacity, shape;
};
SplatFunctions splat_functions(const LightFieldHeader& header);

/// What 1 is in the planes of each function. [K]
std::vector<double> plane_units(const LightFieldHeader& header);

/// Given planes of one point (slf/given_planes.h) as real numbers.
class PointValues {
 public:
  /// units: plane_units(); kept by reference, as the planes are.
  PointValues(std::span<const double> units, const std::int32_t* planes)
      : units_(units), planes_(planes) {}

  double operator()(int function, int channel) const {
    const auto k = static_cast<std::size_t>(function);
    return planes_[3 * k + static_cast<std::size_t>(channel)] * units_[k];
  }

 private:
  std::span<const double> units_;
  const std::int32_t* planes_;
};

/// -kLogitBound .. kLogitBound
double logit_of(const PointValues& value, const SplatFunctions& functions);
/// The matrix L: logarithms of deviations along axes.
Symmetric3 log_shape_of(const PointValues& value, const SplatFunctions& functions);

/// A splat's axes, and logarithms of its deviations along them. Where levels were left out, a splat
/// stands for those of its voxel, and is blurred by half of what the voxel spans. Spec E.6
Axes3 shape_axes(const LightFieldHeader& header, const PointValues& value,
                 const SplatFunctions& functions);

/// Splats as a page draws them.
struct SplatShapes {
  std::vector<std::array<float, 6>> covariances;  ///< xx, xy, xz, yy, yz, zz; world units squared
  std::vector<float> opacities;                   ///< 0 .. 1
};

/// Shapes of a light field for which has_gaussians() holds. O(P K). The same for any thread count.
SplatShapes splat_shapes(const LightField& field, int threads);

}  // namespace slf
