// The encoder's side of attributes/plane_transform.h.
#pragma once

#include <array>
#include <cstdint>
#include <span>
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
  double gain = 0;  ///< no component exceeds this times the root of its lane's weighted squares
};

/// Finds the components of one row at a time.
class ComponentFinder {
 public:
  /// steps: [planes]. Both are kept by reference.
  ComponentFinder(const ForwardTransform& transform, std::span<const std::uint32_t> steps);

  /// Replaces the values of the functions in a row by components, rounded: those of the planes
  /// behind the rank, and all where none would reach half a step, become 0.
  void find(std::int32_t* row);

 private:
  const ForwardTransform& forward_;
  double least_step_;
  std::vector<double> values_, components_;  // [elements][lanes]
};

}  // namespace slf
