// SPDX-License-Identifier: Apache-2.0
// The matrices that make given functions of few coded ones. Spec 7.11, 8.7.5.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace slf {

/// Functions of direction that are sums of basis functions: component r of a point stands for
/// e_r = sum_k M[k][r] b_k. With lanes = 3 the three channels are alike, each by itself; with
/// lanes = 1 (joint) the matrix is over functions and channels together.
struct PlaneTransform {
  static constexpr int kFractionBits = 14;
  static constexpr std::uint32_t kMaxEntries = 1u << 20;
  static constexpr std::int32_t kEntryLimit = 1 << 20;  ///< |entry| <= this: 64
  static constexpr int kColourBits = 9;
  static constexpr std::array<std::array<std::int32_t, 3>, 3> kNoColour{
      {{1 << kColourBits, 0, 0}, {0, 1 << kColourBits, 0}, {0, 0, 1 << kColourBits}}};

  std::size_t first_group = 0, num_groups = 1;
  std::vector<std::uint16_t> functions;  ///< [S] of its groups, by group, ascending within one
  std::size_t rank = 0;                  ///< R: coded functions, >= 1
  std::size_t lanes = 3;                 ///< 3, or 1
  /// With 3 lanes: from coded channels (columns) to channels, 9 fractional bits, |entry| <= 512.
  std::array<std::array<std::int32_t, 3>, 3> colour = kNoColour;
  std::vector<std::int32_t> matrix;  ///< [columns][rows], 14 fractional bits
  /// [<= R] places of its functions in LightField::components; those of groups left out are
  /// missing from the end.
  std::vector<std::uint16_t> components;

  std::size_t rows() const { return functions.size() * 3 / lanes; }
  std::size_t columns() const { return rank * 3 / lanes; }
};

}  // namespace slf
