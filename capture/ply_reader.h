// SPDX-License-Identifier: Apache-2.0
// A PLY file as a whole.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "slf/capture.h"

namespace slf {

/// Indices of faces are those of the file: whether there are such vertices is check_mesh's matter.
/// Errors and warnings as read_mesh.
Result<Mesh, InputError> read_ply_mesh(const std::filesystem::path& file, bool with_faces,
                                       std::vector<std::string>* warnings);

}  // namespace slf
