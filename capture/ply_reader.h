// SPDX-License-Identifier: Apache-2.0
// A PLY file as a whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "slf/capture.h"

namespace slf {

/// Indices of faces are those of the file: whether there are such vertices is check_mesh's matter.
/// Errors and warnings as read_mesh.
Result<Mesh, InputError> read_ply_mesh(const std::filesystem::path& file, bool with_faces,
                                       std::vector<std::string>* warnings);

/// How many vertices the header says. No row is read.
/// @errors kUnreadable; kInvalidInput: what a header refuses, none of vertices
Result<std::uint64_t, InputError> ply_vertices(const std::filesystem::path& file);

}  // namespace slf
