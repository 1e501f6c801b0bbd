// SPDX-License-Identifier: Apache-2.0
// Integer components to real weights in R, G, B. Spec 6.7, 6.5.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "slf/types.h"
#include "slf/view_map.h"

namespace slf {

/// Components to R, G, B: one 3 x 3 matrix each, with the channels of a transform folded in.
class ComponentColours {
 public:
  /// @param shifted  2^-shift too, of the function that a component stands for
  ComponentColours(const LightFieldHeader& header, bool shifted) {
    const auto matrix = colour_matrix(header.colour);
    const auto count = static_cast<std::size_t>(header.num_components());
    std::vector<std::array<std::array<double, 3>, 3>> mixed(count, matrix);
    for (const PlaneTransform& t : header.transforms)
      for (const std::uint16_t r : t.components)
        for (std::size_t to = 0; to < 3; ++to)
          for (std::size_t c = 0; c < 3; ++c) {
            mixed[r][to][c] = 0;
            for (std::size_t by = 0; by < 3; ++by)
              mixed[r][to][c] +=
                  std::ldexp(matrix[to][by] * t.colour[by][c], -PlaneTransform::kColourBits);
          }
    for (std::size_t r = 0; r < count; ++r) {
      const std::size_t k = header.coded.empty() ? r : header.coded[r];
      const int shift = shifted && k < header.shift.size() ? header.shift[k] : 0;
      for (const auto& row : mixed[r])
        for (const double m : row) factors_.push_back(static_cast<float>(std::ldexp(m, -shift)));
    }
  }

  /// [R][3] integers to [R][3] R, G, B.
  void apply(const std::int32_t* components, float* rgb) const {
    for (const float *m = factors_.data(), *end = m + factors_.size(); m != end; m += 9) {
      if ((components[0] | components[1] | components[2]) != 0) {
        const auto c0 = static_cast<float>(components[0]);
        const auto c1 = static_cast<float>(components[1]);
        const auto c2 = static_cast<float>(components[2]);
        for (int c = 0; c < 3; ++c) rgb[c] = m[3 * c] * c0 + m[3 * c + 1] * c1 + m[3 * c + 2] * c2;
      } else {
        rgb[0] = rgb[1] = rgb[2] = 0;
      }
      components += 3;
      rgb += 3;
    }
  }

 private:
  std::vector<float> factors_;  // [R][3][3]
};

}  // namespace slf
