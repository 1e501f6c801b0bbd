// SPDX-License-Identifier: Apache-2.0
// What every training of a capture would find anew.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "capture/surface_points.h"
#include "slf/camera_trust.h"
#include "slf/gaussians.h"
#include "slf/surface.h"

namespace slf {

/// What stands behind the object in a photograph, and how far the object is.
struct ViewSetting {
  std::array<std::uint8_t, 3> background{};
  float depth = 1;  ///< TrainingCamera::depth
};

/// Splats that some of the photographs trained.
struct SplatTrial {
  TrialFile file;    ///< bytes 0: photographs agree on no splat
  Gaussians splats;  ///< as they were trained
};

/// Trials of more and more splats.
struct SplatsThatPay {
  std::size_t number = 0;  ///< that are worth their bytes; 0: as many as ever
  TrialFile best;          ///< of so many
  std::vector<TrialFile> trials;
};

/// For trainings of one capture, one after the other. It fills as they run and changes nothing of
/// them but their time.
struct TrainingCache {
  std::vector<Float3> normals;                    ///< [points] where the capture has none
  std::vector<std::optional<ViewSetting>> views;  ///< [cameras]
  bool outlined = true;  ///< of splats: photographs tell one object from its background
  /// Photographs that agree nowhere with what was trained: it is to be trained without them.
  std::vector<CameraTrust> foreign;
  std::optional<SplatTrial> tried;  ///< by three quarters of the photographs
  std::optional<SplatsThatPay> that_pay;
};

}  // namespace slf
