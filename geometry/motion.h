// SPDX-License-Identifier: Apache-2.0
// Where the points of a frame were in the frame that it is predicted from. Spec 8.12.1.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "slf/types.h"

namespace slf {

/// A displacement, or part of one, in sixteenths of a voxel.
using Displacement = std::array<std::int32_t, 3>;

/// An affine motion, and on a lattice what is added to it, linear between the lattice's points.
struct Motion {
  static constexpr int kMatrixBits = 16;                     ///< fractional bits of the matrix
  static constexpr std::int32_t kMostEntry = (1 << 17) - 1;  ///< of the matrix
  static constexpr std::int32_t kMostShift = (1 << 20) - 1;  ///< of a displacement's parts

  std::array<std::array<std::int32_t, 3>, 3> matrix{};  ///< of the position from the centre
  Displacement shift{};
  int lattice_log2 = 0;  ///< distance of the lattice's points in voxels, 3 .. 8; 0: no lattice
  std::array<std::int32_t, 3> lattice_first{}, lattice_size{};  ///< in steps of the lattice
  std::vector<Displacement> lattice;                            ///< x fastest

  bool is_zero() const { return *this == Motion{}; }
  bool operator==(const Motion&) const = default;

  /// @param place  in halves of a voxel: the centre of voxel v is 2 v + 1
  /// @param bits   of the grid
  Displacement at(const std::array<std::int32_t, 3>& place, int bits) const {
    std::array<std::int64_t, 3> sum{};
    const std::int32_t centre = 1 << bits;
    for (std::size_t i = 0; i < 3; ++i) {
      std::int64_t product = std::int64_t{1} << (kMatrixBits - 4);
      for (std::size_t j = 0; j < 3; ++j)
        product += std::int64_t{matrix[i][j]} * (place[j] - centre);
      sum[i] = shift[i] + (product >> (kMatrixBits - 3));  // halves of a voxel are 8 sixteenths
    }
    if (lattice_log2 > 0) add_lattice(place, sum);
    Displacement d{};
    for (std::size_t i = 0; i < 3; ++i)
      d[i] = static_cast<std::int32_t>(
          std::clamp(sum[i], std::int64_t{-kMostShift - 1} * 16, std::int64_t{kMostShift} * 16));
    return d;
  }

 private:
  void add_lattice(const std::array<std::int32_t, 3>& place,
                   std::array<std::int64_t, 3>& sum) const;
};

}  // namespace slf
