// SPDX-License-Identifier: Apache-2.0
// Holes that mending tore: where a photograph would show what is behind the object.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "capture/surface_points.h"
#include "slf/capture.h"

namespace slf {

/// [P of before] 1: cameras that saw this point see nothing at all there after, although the
/// object's outline is farther away than a fat cloud explains. With what is next to such points.
std::vector<std::uint8_t> shines_through(const Capture& capture, std::span<const int> cameras,
                                         const SurfacePoints& before, const SurfacePoints& after,
                                         double spacing, int threads);

}  // namespace slf
