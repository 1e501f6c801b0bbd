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

}  // namespace slf
