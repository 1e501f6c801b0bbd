// Which side of a mesh is its outside.
#pragma once

#include <vector>

#include "slf/capture.h"

namespace slf {

/// Turns all faces and normals where most of what the cameras see first faces away from them.
/// @return whether it did
bool turn_towards(const std::vector<Camera>& cameras, Mesh& mesh);

}  // namespace slf
