// SPDX-License-Identifier: Apache-2.0
// Which cameras of a capture see what the others see.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "slf/error.h"
#include "slf/fit.h"

namespace slf {

enum class CameraVerdict : std::uint8_t {
  kKept,
  kGainCorrected,  ///< another exposure or white balance: its colours count times `gain`
  kDropped,  ///< another object, a wrong pose, or all overexposed: its observations do not count
};

/// What tells whether one input camera's photograph belongs to its place: patterns, not colours.
/// Highlights move with the camera and change colours, but a picture of something else, or one
/// projected from a wrong pose, agrees nowhere.
struct CameraTrust {
  int camera = 0;  ///< index into the capture's cameras
  CameraVerdict verdict = CameraVerdict::kKept;
  /// Factors of R, G, B (in the observations' transfer) that make the photograph what the others
  /// see; 1 but for kGainCorrected.
  std::array<float, 3> gain{1, 1, 1};
  double agreement = 1;       ///< of its pattern with the others', -1 .. 1: the upper quartile of
                              ///< correlations over patches of points
  double peer_agreement = 1;  ///< the same of its nearest camera, without it; where too little of
                              ///< the surface has a pattern, both are 1
  double clipped_share = 0;   ///< of its observations, at the upper end of a channel
};

/// Compares what every camera sees with a prediction from the others, at some of the points.
/// @param observations  of world directions, points in Morton order
/// @return one per camera that sees anything, ascending. All are kept where fewer than 4 do. At
/// most
///         a third of them are dropped.
/// @errors kInvalidInput: the photographs agree nowhere with each other, so none supports the
/// cloud. The same for any thread count. Below 1e8 pairs of observations, once, and again for every
/// camera that is not kept.
Result<std::vector<CameraTrust>, InputError> check_cameras(const Observations& observations,
                                                           int threads);

/// The observations of cameras that are not dropped, with their gains; what a corrected camera sees
/// at the upper end of a channel is left out. `trust` may be empty: all are kept.
Observations trusted_observations(Observations observations, const std::vector<CameraTrust>& trust);

/// Those that are not dropped, ascending.
std::vector<int> trusted_cameras(const std::vector<CameraTrust>& trust);

/// "dropped: ...", for a person; empty where the camera is kept.
std::string reason_of(const CameraTrust& trust);

}  // namespace slf
