// SPDX-License-Identifier: Apache-2.0
// The encoder's side of attributes/plane_transform.h.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "attributes/plane_transform.h"

namespace slf {

/// A transform with what finds the components of given values: the least squares of the matrix as
/// coded, so that its rounding does not matter where the rank is full.
struct ForwardTransform {
  PlaneTransform inverse;
  std::vector<std::uint8_t> precision;            ///< [columns] fractional bits of coded entries
  std::vector<double> weights;                    ///< [rows] of the squared errors that are least
  std::vector<double> matrix;                     ///< [columns][rows] values to components
  std::array<std::array<double, 3>, 3> colour{};  ///< inverse of that of `inverse`, for 3 lanes
};

/// Finds the components of one point at a time.
class ComponentFinder {
 public:
  /// Kept by reference.
  explicit ComponentFinder(const ForwardTransform& transform);

  /// @param planes      [K][3] given values of a point
  /// @param components  [R][3] receives those of the transform, rounded
  void find(const std::int32_t* planes, std::int32_t* components);

 private:
  const ForwardTransform& forward_;
  std::vector<double> values_, components_;  // [elements][lanes]
};

}  // namespace slf
