// SPDX-License-Identifier: Apache-2.0
// Geometry mended by photographs before it is coded.
#pragma once

#include <cstddef>
#include <cstdint>

namespace slf {

enum class RefineGeometry : std::uint8_t {
  kOff,   ///< points stay where the capture has them: scans, exact models
  kOn,    ///< mended wherever held-out photographs gain
  kAuto,  ///< the same, if all in all they gain by 15 % or more of their squared error
};

/// What was moved. Errors are those of predicting every fourth input photograph from the others at
/// the points that it sees; mending does not see those photographs.
struct RefineReport {
  enum Outcome : std::uint8_t {
    kNotAsked,
    kTooFewCameras,  ///< fewer than 8
    kTooManyPoints,  ///< more than 2 million: nothing for photographs to add
    kTooFewPoints,   ///< fewer than 1000
    kNoGain,         ///< tried, and the capture's points kept
    kMended,
    kOutdone,  ///< of kAuto: splats are far ahead of the points, so mending was not tried
  };
  Outcome outcome = kNotAsked;
  std::size_t points_before = 0, points_after = 0;
  std::size_t moved = 0;    ///< of those after: by more than half a voxel
  std::size_t removed = 0;  ///< of those before: merged with others, or supported by none
  std::size_t added = 0;    ///< of those after: a second or further one from the same point before
  std::size_t kept_back = 0;  ///< of those before: kept in place, as mending did not help there
  double median_move = 0, max_move = 0;            ///< along the normal, voxels, of those moved
  double held_out_before = 0, held_out_after = 0;  ///< dB
  /// Photographs disagree about points that are nearer to one another than they tell apart. Such a
  /// cloud is thinned first on an automatic grid alone: on a given one it is hardly ever mended.
  /// kAuto alone sets it.
  bool too_dense_for_grid = false;
  bool exact = false;  ///< photographs agree at the points already: nothing was tried. Of kAuto
  double seconds = 0;
};

}  // namespace slf
