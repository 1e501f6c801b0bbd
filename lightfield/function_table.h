// SPDX-License-Identifier: Apache-2.0
// The coded functions along directions: sums of basis functions, worked out once. Spec 6.7, 8.7.5.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "lightfield/harmonics.h"
#include "slf/types.h"

namespace slf {

/// The R functions e_r = sum_k M[k][r] 2^-shift_k b_k of a header whose transforms are not joint.
/// Thread-safe.
class FunctionTable {
 public:
  /// @param threads  for the table of directions, which is made when look_up first needs it
  FunctionTable(const LightFieldHeader& header, int threads);

  std::size_t size() const { return size_; }
  /// Floats that a row has to hold: size() and some that are 0.
  std::size_t stride() const { return stride_; }

  /// e_r along (theta, gamma), as exact as float sums are. O(K R); splines of order o: O(o o R).
  void evaluate(const std::array<float, 2>& direction, float* row) const;

  /// The same along a unit vector, from a table: cubic splines on the faces of a cube. O(R). Of
  /// harmonics alone.
  void look_up(const std::array<float, 3>& direction, float* row) const;

 private:
  static constexpr int kCells = 32;  ///< a side of a face; kh = 10 / 16 for degree 10: error 2e-4
  static constexpr int kSide = kCells + 3;

  void make_faces() const;

  Basis basis_;
  int threads_;
  std::size_t size_, stride_;
  std::unique_ptr<const Harmonics> harmonics_;
  /// [K][stride] weights of the basis functions; of splines [nodes][stride], those of the nodes.
  std::vector<float> matrix_;
  mutable std::once_flag once_;
  mutable std::vector<float> faces_;  // [6][kSide][kSide][stride] of splines
};

}  // namespace slf
