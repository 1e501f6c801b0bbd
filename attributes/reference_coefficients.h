// SPDX-License-Identifier: Apache-2.0
// The coefficients that the frame before has in the places of those of a predicted frame: how large
// they are tells how large the difference from them will be. Spec 8.12.6.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "attributes/raht_tree.h"
#include "attributes/reference_means.h"

namespace slf {

/// Magnitudes, by row of the tree, in quarters of the steps.
class ReferenceCoefficients {
 public:
  static constexpr std::uint8_t kLargest = 127;  ///< they are kept up to this
  static constexpr std::uint8_t kNone = 255;     ///< the reference has nothing there

  ReferenceCoefficients(std::size_t rows, std::size_t planes)
      : planes_(planes), quarters_(rows * planes, kNone) {}

  std::uint8_t* row(std::size_t r) { return quarters_.data() + r * planes_; }
  const std::uint8_t* row(std::size_t r) const { return quarters_.data() + r * planes_; }

 private:
  std::size_t planes_;
  std::vector<std::uint8_t> quarters_;  // [rows][planes]
};

/// Rows that are points, or nodes of a level, of a frame without a base.
struct ReferenceRows {
  const RahtTree& tree;
  std::span<const std::uint64_t> codes;  ///< of all points
  std::span<const std::uint32_t> first;  ///< [rows + 1] first point of each
  int levels;                            ///< of the rows
};

/// @param reference  means of rows.levels levels and the root
/// @param steps      [planes]
/// O(rows * (levels + planes)).
ReferenceCoefficients find_reference_coefficients(const ReferenceRows& rows,
                                                  const ReferenceMeans& reference,
                                                  std::span<const std::uint32_t> steps);

}  // namespace slf
