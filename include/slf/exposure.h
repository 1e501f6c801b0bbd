// SPDX-License-Identifier: Apache-2.0
// Photographs of one capture whose exposure and white balance differ.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace slf {

/// Whether photographs are made to agree in exposure and white balance before anything is made of
/// them.
enum class MatchExposure : std::uint8_t {
  kOff,
  kOn,    ///< always
  kAuto,  ///< where most photographs differ, and gains explain it
};

/// What photographs see of the same points, and the gains that make it agree.
struct ExposureReport {
  /// [cameras of the capture] factors of R, G, B, of display values, 1 for a camera that is not
  /// used; their geometric mean over used cameras is 1. Empty: photographs stay as they are.
  std::vector<std::array<float, 3>> gains;
  /// Medians over pairs of neighbouring photographs of |log ratio| of what they see: as they are,
  /// and with the gains. 0 where nothing could be compared.
  double differ = 0, differ_matched = 0;
  std::size_t pairs = 0;  ///< of photographs that were compared
  double seconds = 0;
};

}  // namespace slf
