// SPDX-License-Identifier: Apache-2.0
// Real spherical harmonics. Spec 6.3 (basis 1).
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace slf {

inline constexpr int kMaxDegree = 10;

/// Evaluates all functions up to a degree along a direction by recursion. Function l * l + l + m,
/// m = -l .. l, in the sign convention of 3-D Gaussian splatting files (Condon-Shortley), but of
/// mean square 1 over the sphere: theirs times sqrt(4 pi). Function 0 is 1. Thread-safe.
class Harmonics {
 public:
  /// @param degree  L, 0 .. kMaxDegree
  explicit Harmonics(int degree);

  static constexpr std::size_t kLanes = 8;  ///< directions at once
  static constexpr std::size_t kMost = std::size_t{kMaxDegree + 1} * (kMaxDegree + 1);

  int size() const { return (degree_ + 1) * (degree_ + 1); }

  /// @param direction  unit length
  /// @param row  receives size() values. Exact to 1e-12 in double, 1e-4 in float.
  template <class Real>
  void evaluate(const std::array<double, 3>& direction, Real* row) const;

  /// Values of kLanes directions at once, in float: exact to 1e-4.
  /// @param directions  [3] unit length
  /// @param rows  [size()] receives the values
  void evaluate(const std::array<std::array<float, kLanes>, 3>& directions,
                std::array<float, kLanes>* rows) const;

  /// The same of any number, side by side.
  /// @param columns  [size()][stride] receives the values; stride: a multiple of kLanes, at least
  ///                 the number of directions. What is behind it repeats the last.
  void evaluate_columns(std::span<const std::array<double, 3>> directions, float* columns,
                        std::size_t stride) const;

  /// The same of any number.
  /// @param directions  unit length
  /// @param rows  [directions][size()] receives the values
  void evaluate(std::span<const std::array<double, 3>> directions, float* rows) const;

 private:
  /// The step of function (l, m), m >= 0: from the Legendre functions of l and l - 1 to l + 1.
  struct Step {
    double norm;  // of (l, m) and (l, -m), sign included
    double from_this, from_before;
  };

  int degree_;
  std::vector<Step> steps_;  // by m, then l
};

}  // namespace slf
