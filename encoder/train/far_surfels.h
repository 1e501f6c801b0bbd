// SPDX-License-Identifier: Apache-2.0
// What photographs show behind everything that has points: sky, hills, the walls of a room.
#pragma once

#include <cmath>
#include <span>

#include "encoder/train/trained_surfel.h"
#include "encoder/train/training_view.h"

namespace slf {

/// Where cameras stand, and how far they look.
struct ViewedSpace {
  Float3 centre{};   ///< of the cameras
  float radius = 0;  ///< within which the cameras and what they look at lie; 0: not known

  /// How many times larger a pixel is there than on what the cameras look at: 1 or more.
  float pixels_at(const Float3& at) const {
    if (!(radius > 0)) return 1;
    const Float3 from = minus(at, centre);
    return std::max(1.0f, std::sqrt(dot(from, from)) / radius);
  }
};
ViewedSpace viewed_space(std::span<const TrainingView> views);

/// Surfels on a sphere far about the cameras, one for each direction in which photographs show
/// something where `near` draws nothing. They face the cameras and have the photographs' colours.
/// @param most  surfels
/// The same for any number of threads. O(pixels).
TrainedSurfels far_surfels(std::span<const TrainingView> views, const TrainedSurfels& near,
                           std::size_t most, int threads);

}  // namespace slf
