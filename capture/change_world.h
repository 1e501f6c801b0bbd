// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slf/capture.h"
#include "slf/points_world.h"

namespace slf {

/// Moves points, turns normals, and keeps the outside of faces where the change mirrors.
void change_world(const WorldChange& change, Mesh& mesh);

}  // namespace slf
