// SPDX-License-Identifier: Apache-2.0
// The faces of a PLY file.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "capture/ply_body.h"
#include "slf/error.h"

namespace slf {

/// Polygons as fans of their first corner; fewer than three corners are no triangle.
/// @param name  of the file, for messages
/// @errors kInvalidInput: no list vertex_indices (or vertex_index) of whole numbers; an index
///         below 0; a face that is cut off.
Result<std::vector<std::array<std::uint32_t, 3>>, InputError> read_ply_faces(
    const std::string& name, const PlyElement& face, PlyBody& body);

/// Rows of the element `tristrips`, as the Stanford archive has them: strips whose triangles turn
/// about one after the other; -1 ends one.
/// @errors kInvalidInput
Result<std::vector<std::array<std::uint32_t, 3>>, InputError> read_ply_strips(
    const std::string& name, const PlyElement& strips, PlyBody& body);

}  // namespace slf
