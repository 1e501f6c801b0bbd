// SPDX-License-Identifier: Apache-2.0
// Which side of a point's surface can be seen: normals of a light field have either sign.
#pragma once

#include <array>
#include <vector>

#include "slf/render.h"
#include "slf/view_map.h"

namespace slf {

/// Turns normals towards the side from which points are seen more, by cameras all around the scene
/// that draw its depth.
/// @param normals  [P] unit or 0, of either sign; those seen from behind are negated
/// @return [P] 0.5 .. 1: the share of the views that are on the normal's side, each counted by its
///         cosine; 0.5 where none sees the point: inside, or within a room
std::vector<float> turn_to_visible_side(const ViewMaps& maps,
                                        std::vector<std::array<float, 3>>& normals, int threads);

}  // namespace slf
