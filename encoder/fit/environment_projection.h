// SPDX-License-Identifier: Apache-2.0
// An environment in the functions of a basis, per point.
#pragma once

#include <array>
#include <span>

#include "encoder/fit/direction_rows.h"
#include "encoder/fit/environment.h"
#include "encoder/fit/fitted_rows.h"
#include "slf/types.h"

namespace slf {

/// The combination of functions nearest to what a point reflects of the environment, over all
/// directions: those in front of the surface count ten times those behind it, which no camera
/// can see, with a penalty that keeps it from growing there.
/// @param positions  [P] in the object's box
/// @param normals    [P] outward, unit
/// @param rows       [P][K][3] receives it, of the functions scaled to mean square 1
void project_environment(const Environment& environment, std::span<const Vec3> positions,
                         std::span<const std::array<float, 3>> normals, Directions directions,
                         const DirectionRows& basis, int threads, FittedRows& rows);

}  // namespace slf
