// SPDX-License-Identifier: Apache-2.0
// How well what a camera sees agrees with what the others see of the same points.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "slf/fit.h"

namespace slf {

/// How the observations of a camera are taken. [highest camera index + 1]
struct CameraState {
  bool dropped = false;
  bool corrected = false;  ///< times gain; what is clipped is left out
  std::array<float, 3> gain{1, 1, 1};
};

/// What one camera and its peers agree on. Quantiles are 0 of no samples.
struct CameraAgreement {
  std::size_t patches = 0;                   ///< that have a pattern
  double agreement = 0, peer_agreement = 0;  ///< upper quartiles of correlations over patches
  double colour_ratio = 0;  ///< squared colour differences over those of its neighbours, trimmed
  /// Median of log(prediction / own) in each channel over what neither clips nor is dark, and the
  /// distance of the quartiles of the channels' mean.
  std::array<double, 3> log_gain{};
  double log_gain_spread = 0;
  std::size_t gain_samples = 0;
};

/// Grey level from which a channel counts as clipped.
inline constexpr float kClipped = 253;

/// Patches of 64 points that are neighbours in Morton order, spread over the cloud.
std::vector<std::size_t> choose_patches(const Observations& observations);

/// [highest camera index + 1]. The prediction of an observation is the mean of the others at its
/// point, weighted by 1 / (angle^2 + 3 degrees^2)^2. O(pairs of observations of a point).
/// The same for any thread count.
std::vector<CameraAgreement> camera_agreement(const Observations& observations,
                                              const std::vector<std::size_t>& patches,
                                              const std::vector<CameraState>& states, int threads);

}  // namespace slf
