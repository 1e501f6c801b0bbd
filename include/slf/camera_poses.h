// SPDX-License-Identifier: Apache-2.0
// Cameras of one capture whose poses are not quite right.
#pragma once

#include <cstdint>
#include <vector>

#include "slf/capture.h"

namespace slf {

/// Whether cameras are moved to where photographs agree best, before anything is made of them.
enum class RefineCameras : std::uint8_t {
  kOff,
  kOn,
};

/// What became of the cameras.
struct PoseReport {
  /// [cameras of the capture] with poses as they are used: those that are not used as they were,
  /// and sizes of the photographs as the encoder has them. Empty: all stay as they are.
  std::vector<Camera> cameras;
  /// How far pictures of the points moved, root mean square over the points: the median and the
  /// most of all used cameras, pixels of the photographs as the encoder has them
  /// (EncoderSettings::photograph_pixels).
  double median_pixels = 0, most_pixels = 0;
  int moved_most = 0;  ///< the camera
  double seconds = 0;
};

}  // namespace slf
