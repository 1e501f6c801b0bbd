// SPDX-License-Identifier: Apache-2.0
// Mesh files other than PLY. No library reads them: tinyobjloader takes what is no number for 0,
// and tinygltf 2.7 copies up to eight bytes from behind a file whose binary chunk is too long;
// either would need most of a reader around it to be told where a hostile file is wrong.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "slf/capture.h"

namespace slf {

/// Wavefront OBJ: v, vn, f; the rest is materials, groups and curves.
/// @param name  of the file, for messages
/// @errors kInvalidInput: names the line.
Result<Mesh, InputError> parse_obj(const std::string& name, std::span<const std::uint8_t> text);

/// STL, binary or ASCII, without normals.
/// @errors kInvalidInput: names the facet or the line.
Result<Mesh, InputError> parse_stl(const std::string& name, std::span<const std::uint8_t> file);

/// glTF 2.0 in its binary form, everything in the one file: the triangles of the default scene.
/// @errors kInvalidInput: names the place in the JSON chunk.
Result<Mesh, InputError> parse_glb(const std::string& name, std::span<const std::uint8_t> file,
                                   std::vector<std::string>* warnings);

/// The same of a .gltf: buffers are in it or in files of its folder.
Result<Mesh, InputError> parse_gltf(const std::filesystem::path& file,
                                    std::span<const std::uint8_t> text,
                                    std::vector<std::string>* warnings);

/// Every index is a vertex, every coordinate finite, normals of unit length or none at all.
/// @errors kInvalidInput: names the triangle or the vertex.
Result<Done, InputError> check_mesh(const std::string& name, Mesh& mesh);

}  // namespace slf
