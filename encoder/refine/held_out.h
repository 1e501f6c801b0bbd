// SPDX-License-Identifier: Apache-2.0
// How well photographs predict each other through a surface: what mending must lower.
#pragma once

#include <span>
#include <vector>

#include "capture/surface_points.h"
#include "slf/capture.h"
#include "slf/error.h"
#include "slf/types.h"

namespace slf {

/// Errors of the held-out photographs, by point.
struct HeldOutErrors {
  std::vector<float> squares;  ///< [P] sum over views of (8-bit levels)^2, mean of R, G and B
  std::vector<float> views;    ///< [P] sum of weights: the cosines, as that much area is seen

  std::vector<std::uint8_t> seen;  ///< [P] 1: by any of the cameras, held out or not

  double mean() const;
  double squares_sum() const;
};

/// The errors of both together.
double mean_of(const HeldOutErrors& a, const HeldOutErrors& b);

/// The cameras that mending does not see: every fourth.
struct CameraParts {
  std::vector<int> matched, held_out;
};
CameraParts split_for_mending(std::span<const int> cameras);

/// Every held-out camera is predicted from the others at every point that it sees: their mean and
/// what is linear in direction, as light that moves makes it.
/// @param every  of so many points one is looked at and stands for the others, which have zeros
Result<HeldOutErrors, InputError> held_out_errors(const Capture& capture,
                                                  std::span<const int> cameras,
                                                  const SurfacePoints& points, double spacing,
                                                  int threads, std::size_t every = 1);

}  // namespace slf
