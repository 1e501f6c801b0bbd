// SPDX-License-Identifier: Apache-2.0
// How large photographs must be for the points that are seen in them.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "slf/capture.h"

namespace slf {

/// log2 of how much smaller a photograph may be: a pixel spans at most half a spacing on what is
/// `nearest` to the camera along its axis. 0 where nothing is in front.
int least_photograph(const Camera& camera, double nearest, double spacing);

/// What load_image needs of a capture: no points, no mesh.
Capture photographs_alone(const Capture& capture);

/// The capture with photographs as many times halved as `log2` has it; nothing if all of it is 0.
/// @param log2  [cameras]
std::optional<Capture> smaller_photographs(const Capture& capture, std::span<const int> log2);

/// The capture with photographs no larger than its points need, as least_photograph has it; nothing
/// where none can be smaller. What a fit holds of a photograph grows with its pixels, and a colour
/// per point has no use for more.
/// @param positions  [points] world; up to 2000 spread evenly are looked at
std::optional<Capture> photographs_for_points(const Capture& capture, std::span<const int> cameras,
                                              std::span<const std::array<float, 3>> positions,
                                              double spacing);

/// The capture with photographs of so many millions of pixels at most; nothing where none has more,
/// and with 0.
std::optional<Capture> photographs_within(const Capture& capture, double megapixels);

}  // namespace slf
