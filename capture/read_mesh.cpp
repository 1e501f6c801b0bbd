// SPDX-License-Identifier: Apache-2.0
// Which reader a mesh file has, and what every mesh has to be.
#include <algorithm>
#include <cmath>

#include "capture/file_names.h"
#include "capture/mend_normals.h"
#include "capture/mesh_formats.h"
#include "capture/ply_reader.h"
#include "capture/read_scan.h"
#include "slf/capture.h"

namespace slf {

namespace {

constexpr std::uint64_t kMostBytesOfMesh = std::uint64_t{1} << 31;  // of an OBJ, GLB or STL file

Result<Mesh, InputError> read_by_extension(const std::filesystem::path& file,
                                           std::vector<std::string>* warnings) {
  const std::string extension = extension_of(file);
  if (is_scan(file)) {
    SLF_TRY(Scan scan, read_scan(file, warnings));
    return std::move(scan.points);
  }
  if (extension == ".fbx" || extension == ".dae" || extension == ".3mf" || extension == ".usdz")
    return InputError{Errc::kInvalidInput,
                      file.string() + ": " + extension.substr(1) +
                          " is not read: export the mesh as PLY, OBJ or GLB (MeshLab, Blender)"};
  if (extension != ".obj" && extension != ".glb" && extension != ".gltf" && extension != ".stl")
    return read_ply_mesh(file, true, warnings);
  SLF_TRY(const auto bytes, read_file(file, kMostBytesOfMesh));
  if (extension == ".obj") return parse_obj(file.string(), bytes);
  if (extension == ".stl") return parse_stl(file.string(), bytes);
  if (extension == ".gltf") return parse_gltf(file, bytes, warnings);
  return parse_glb(file.string(), bytes, warnings);
}

}  // namespace

Result<Mesh, InputError> read_mesh(const std::filesystem::path& file,
                                   std::vector<std::string>* warnings) {
  SLF_TRY(Mesh mesh, read_by_extension(file, warnings));
  SLF_CHECK(check_mesh(file == "-" ? "standard input" : file.string(), mesh));
  return mesh;
}

Result<Done, InputError> check_mesh(const std::string& name, Mesh& mesh) {
  const auto invalid = [&](const char* what, std::size_t i, const std::string& cause) {
    return InputError{Errc::kInvalidInput, name + ": " + what + " " + std::to_string(i) + cause};
  };
  const auto& vertices = mesh.vertices;
  const std::size_t count = vertices.positions.size();
  if (count == 0) return InputError{Errc::kInvalidInput, name + ": no points"};
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (const std::uint32_t v : mesh.triangles[f])
      if (v >= count)
        return invalid("triangle", f,
                       " has the vertex " + std::to_string(v) + " of " + std::to_string(count));
  for (std::size_t v = 0; v < count; ++v)
    for (const float x : vertices.positions[v])
      if (!std::isfinite(x)) return invalid("vertex", v, " is not finite");
  mend_normals(mesh);
  return Done{};
}

}  // namespace slf
