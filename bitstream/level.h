// SPDX-License-Identifier: Apache-2.0
// What a stream of a level promises not to exceed. Spec 9, table 9-1.
#pragma once

#include <array>
#include <cstdint>

namespace slf {

struct LevelLimits {
  std::uint64_t rows;             ///< points and base cells of a frame
  std::uint64_t values;           ///< of all functions of a frame
  std::uint64_t unit_bytes;       ///< of a payload
  std::uint64_t points_a_second;  ///< of a predicted frame, since its reference

  bool admits(std::uint64_t some_rows, std::uint64_t functions) const {
    const std::uint64_t a_row = functions > 0 ? 3 * functions : 1;
    return some_rows <= rows && some_rows <= values / a_row;
  }
};

/// [sps_level]. Level 0 promises nothing beyond the ranges of the elements.
inline constexpr std::array<LevelLimits, 3> kLevels = {{
    {~std::uint64_t{0}, ~std::uint64_t{0}, ~std::uint64_t{0}, ~std::uint64_t{0}},
    {1u << 20, 1u << 26, 1u << 24, 1u << 22},
    {1u << 24, 1u << 30, 1u << 28, 1u << 25},
}};

inline const LevelLimits& level_limits(std::uint32_t sps_level) {
  return kLevels[sps_level < kLevels.size() ? sps_level : 0];
}

}  // namespace slf
