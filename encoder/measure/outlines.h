// SPDX-License-Identifier: Apache-2.0
// The object as the outlines of its photographs have it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "capture/object_outline.h"
#include "slf/capture.h"
#include "slf/error.h"

namespace slf {

struct Outline {
  const Camera* camera = nullptr;
  std::vector<bool> object;  ///< [height][width]; a bit each, since all photographs' are held
};

/// Outlines in the photographs that tell (object_outline); cameras are the capture's own.
/// @errors those of load_image
Result<std::vector<Outline>, InputError> outlines_of(const Capture& capture,
                                                     std::span<const int> cameras, int threads,
                                                     Background background = Background::kLikely);

/// Whether so many photographs tell that the object has a hull.
bool are_outlined(std::size_t outlines, std::size_t cameras);

/// Whether the object may be at a point, half_side to either side: all outlines but a few say so,
/// and enough cameras see it.
bool in_hull(const std::vector<Outline>& outlines, const Vec3& at, double half_side);

}  // namespace slf
