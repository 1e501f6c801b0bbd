// SPDX-License-Identifier: Apache-2.0
// Binary glTF 2.0: the triangles of a scene. Numbers in brackets are clauses of its specification.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/vec3.h"
#include "capture/exact_positions.h"
#include "capture/glb_accessor.h"
#include "capture/glb_draco.h"
#include "capture/gltf_transform.h"
#include "capture/json_numbers.h"
#include "capture/little_endian.h"
#include "capture/mesh_formats.h"

namespace slf {

namespace {

constexpr std::size_t kMostTriangles = std::size_t{1} << 24, kMostVertices = std::size_t{1} << 25;
// Nodes can share what the file has once: a scene has at most so many numbers for each byte of its
// buffers, and for small ones so many more.
constexpr std::size_t kMostNumbers = std::size_t{1} << 28, kNumbersPerByte = 256;
constexpr std::size_t kNumbersOfSmall = std::size_t{1} << 22;
constexpr int kMostDepth = 64;

/// [3.7.2.1] Corners of triangles from a primitive's indices; empty for points and lines.
std::vector<std::array<std::size_t, 3>> triangles_of(std::uint64_t mode, std::size_t indices) {
  std::vector<std::array<std::size_t, 3>> triangles;
  if (mode == 4)
    for (std::size_t i = 0; i + 2 < indices; i += 3) triangles.push_back({i, i + 1, i + 2});
  if (mode == 5)
    for (std::size_t i = 0; i + 2 < indices; ++i)
      triangles.push_back({i, i + 1 + i % 2, i + 2 - i % 2});
  if (mode == 6)
    for (std::size_t i = 1; i + 1 < indices; ++i) triangles.push_back({0, i, i + 1});
  return triangles;
}

Result<JsonItems, InputError> list_of(const JsonView& json, const char* key) {
  const auto found = json.find(key);
  if (!found) return JsonItems{};
  return found->items();
}

/// A name of the file, in a message.
std::string shown(const std::string& name) { return name.substr(0, 60); }

class SceneReader {
 public:
  /// @param folder  of a .gltf, which has files beside it; else empty
  SceneReader(const JsonView& json, std::span<const std::uint8_t> binary,
              std::filesystem::path folder)
      : json_(json), binary_(binary), folder_(std::move(folder)) {}

  Result<Mesh, InputError> read(std::vector<std::string>* warnings) {
    SLF_CHECK(check_extensions());
    SLF_TRY(data_.accessors, list_of(json_, "accessors"));
    SLF_TRY(data_.buffer_views, list_of(json_, "bufferViews"));
    SLF_TRY(data_.buffers, list_of(json_, "buffers"));
    SLF_TRY(data_.contents, GltfBuffers::load(data_.buffers, binary_, folder_));
    SLF_TRY(meshes_, list_of(json_, "meshes"));
    SLF_TRY(nodes_, list_of(json_, "nodes"));
    SLF_TRY(const auto scenes, list_of(json_, "scenes"));
    reached_.resize(nodes_.size());
    SLF_TRY(const auto first, glb_number(json_, "scene", 0, UINT32_MAX));
    if (first >= scenes.size()) return json_.error("there is no such scene");
    SLF_TRY(const auto roots, list_of(scenes[static_cast<std::size_t>(first)], "nodes"));
    for (const JsonView& root : roots)
      SLF_CHECK(add_node(root, {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}, 0));
    if (mesh_.triangles.empty() && !points_.empty()) {  // a cloud, or what is left of a mesh
      has_normals_ = true;
      for (const Points& p : points_) add_vertices(p.matrix, p.positions, p.normals);
      other_primitives_ -= points_.size();
    }
    set_positions(positions_, mesh_.vertices);
    if (!has_normals_) mesh_.vertices.normals.clear();
    if (other_primitives_ > 0 && warnings != nullptr)
      warnings->push_back(json_
                              .error(std::to_string(other_primitives_) +
                                     " primitives of points or lines are left out")
                              .message);
    return std::move(mesh_);
  }

 private:
  /// What only changes how a surface looks can be left out; what hides its triangles cannot.
  Result<Done, InputError> check_extensions() const {
    SLF_TRY(const auto required, list_of(json_, "extensionsRequired"));
    for (const JsonView& item : required) {
      SLF_TRY(const std::string name, item.string());
      const bool harmless = name.starts_with("KHR_materials_") ||
                            name.starts_with("KHR_texture_") || name.starts_with("EXT_texture_") ||
                            name == "KHR_mesh_quantization" || name == "KHR_lights_punctual" ||
                            name == "KHR_draco_mesh_compression";
      if (name.find("meshopt_compression") != std::string::npos)
        return item.error(name +
                          " is not read: export the mesh without compression, or with Draco");
      if (!harmless) return item.error(shown(name) + " is an extension that is not supported");
    }
    return Done{};
  }

  Result<Done, InputError> add_node(const JsonView& index, const NodeMatrix& above, int depth) {
    SLF_TRY(const JsonView node, glb_item(index, nodes_, "node"));
    SLF_TRY(const double number, index.number());
    auto&& reached = reached_[static_cast<std::size_t>(number)];
    if (reached || depth >= kMostDepth) return node.error("is reached twice, or too deep");
    reached = true;
    SLF_TRY(const NodeMatrix own, transform_of(node));
    const NodeMatrix matrix = product(above, own);
    if (const auto mesh = node.find("mesh")) {
      SLF_TRY(const JsonView item, glb_item(*mesh, meshes_, "mesh"));
      SLF_TRY(const auto primitives, list_of(item, "primitives"));
      for (const JsonView& primitive : primitives) SLF_CHECK(add_primitive(primitive, matrix));
    }
    SLF_TRY(const auto children, list_of(node, "children"));
    for (const JsonView& child : children) SLF_CHECK(add_node(child, matrix, depth + 1));
    return Done{};
  }

  Result<Done, InputError> add_primitive(const JsonView& primitive, const NodeMatrix& matrix) {
    SLF_TRY(auto mode, glb_number(primitive, "mode", 4, 6));
    if (mode < 4) {
      ++other_primitives_;
      return mode == 0 ? keep_points(primitive, matrix) : Result<Done, InputError>(Done{});
    }
    SLF_TRY(const DracoMesh given, content_of(primitive, mode));
    const std::size_t count = given.positions.size() / 3, base = positions_.size();
    const auto triangles = triangles_of(mode, given.indices.size());
    if (mesh_.triangles.size() + triangles.size() > kMostTriangles || base + count > kMostVertices)
      return primitive.error("the scene has more than 2^24 triangles or 2^25 vertices");
    add_vertices(matrix, given.positions, given.normals);
    const bool swap = mirrors(matrix);
    const auto vertex = [&](std::size_t corner) {
      return static_cast<std::uint32_t>(base + static_cast<std::size_t>(given.indices[corner]));
    };
    for (const auto& t : triangles)
      mesh_.triangles.push_back({vertex(t[0]), vertex(t[swap ? 2 : 1]), vertex(t[swap ? 1 : 2])});
    return Done{};
  }

  /// @param mode  receives 4 where it was compressed: strips come taken apart
  Result<DracoMesh, InputError> content_of(const JsonView& primitive, std::uint64_t& mode) {
    SLF_TRY(auto compressed, draco_mesh_of(data_, primitive));
    if (compressed) {
      SLF_CHECK(count_numbers(compressed->positions.size(), primitive));
      mode = 4;
      return *std::move(compressed);
    }
    DracoMesh content;
    SLF_TRY(const JsonView attributes, primitive.at("attributes"));
    SLF_TRY(content.positions, attribute(attributes, "POSITION", "VEC3", 3));
    SLF_TRY(content.normals, attribute(attributes, "NORMAL", "VEC3", 3));
    SLF_TRY(content.indices, indices_of(primitive, content.positions.size() / 3));
    return content;
  }

  /// For a scene that has no triangles.
  Result<Done, InputError> keep_points(const JsonView& primitive, const NodeMatrix& matrix) {
    SLF_TRY(const JsonView attributes, primitive.at("attributes"));
    SLF_TRY(auto positions, attribute(attributes, "POSITION", "VEC3", 3));
    SLF_TRY(auto normals, attribute(attributes, "NORMAL", "VEC3", 3));
    num_points_ += positions.size() / 3;
    if (num_points_ > kMostVertices) return primitive.error("the scene has more than 2^25 points");
    points_.push_back({matrix, std::move(positions), std::move(normals)});
    return Done{};
  }

  Result<std::vector<double>, InputError> attribute(const JsonView& attributes, const char* key,
                                                    const char* type, std::size_t components) {
    const auto index = attributes.find(key);
    if (!index) return std::vector<double>{};
    SLF_TRY(const JsonView accessor, glb_item(*index, data_.accessors, "accessor"));
    return numbers_of(accessor, type, components);
  }

  Result<std::vector<double>, InputError> numbers_of(const JsonView& accessor, const char* type,
                                                     std::size_t components) {
    SLF_TRY(auto numbers, read_accessor(data_, accessor, type, components));
    SLF_CHECK(count_numbers(numbers.size(), accessor));
    return numbers;
  }

  Result<Done, InputError> count_numbers(std::size_t count, const JsonView& of) {
    numbers_read_ += count;
    const std::size_t most =
        std::min(kMostNumbers, kNumbersOfSmall + kNumbersPerByte * data_.contents.bytes());
    if (numbers_read_ > most) return of.error("is used too often");
    return Done{};
  }

  /// Without indices the vertices come as they are used.
  Result<std::vector<double>, InputError> indices_of(const JsonView& primitive, std::size_t count) {
    std::vector<double> indices;
    const auto given = primitive.find("indices");
    if (!given) {
      for (std::size_t i = 0; i < count; ++i) indices.push_back(static_cast<double>(i));
      return indices;
    }
    SLF_TRY(const JsonView accessor, glb_item(*given, data_.accessors, "accessor"));
    SLF_TRY(indices, numbers_of(accessor, "SCALAR", 1));
    for (std::size_t i = 0; i < indices.size(); ++i)
      if (!(indices[i] >= 0 && indices[i] < static_cast<double>(count)) ||
          indices[i] != std::floor(indices[i]))
        return accessor.error("index " + std::to_string(i) + " is no vertex of the primitive");
    return indices;
  }

  void add_vertices(const NodeMatrix& matrix, const std::vector<double>& positions,
                    const std::vector<double>& normals) {
    PointCloud& vertices = mesh_.vertices;
    has_normals_ = has_normals_ && normals.size() == positions.size();
    NodeMatrix turn = cofactors(matrix);
    const double sign = mirrors(matrix) ? -1 : 1;  // cofactors of a mirror point inwards
    for (auto& row : turn)
      for (double& x : row) x *= sign;
    for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
      positions_.push_back(moved_by(matrix, {positions[i], positions[i + 1], positions[i + 2]}));
      if (!has_normals_) continue;
      Vec3 normal = moved_by(turn, {normals[i], normals[i + 1], normals[i + 2]});
      const double length = std::hypot(normal[0], normal[1], normal[2]);
      for (double& n : normal) n = length > 0 ? n / length : 0;
      vertices.normals.push_back(to_float(normal));
    }
  }

  const JsonView& json_;
  std::span<const std::uint8_t> binary_;
  std::filesystem::path folder_;
  GlbData data_;
  JsonItems meshes_, nodes_;
  std::vector<bool> reached_;
  bool has_normals_ = true;
  std::size_t numbers_read_ = 0;
  std::size_t other_primitives_ = 0;
  struct Points {
    NodeMatrix matrix;
    std::vector<double> positions, normals;
  };
  std::vector<Points> points_;
  std::size_t num_points_ = 0;
  std::vector<Vec3> positions_;  // of the vertices
  Mesh mesh_;
};

}  // namespace

// [4.4] Magic, version and length; then chunks of length, type and data: JSON first, then BIN.
Result<Mesh, InputError> parse_glb(const std::string& name, std::span<const std::uint8_t> file,
                                   std::vector<std::string>* warnings) {
  const auto invalid = [&](const char* cause) {
    return InputError{Errc::kInvalidInput, name + ": " + cause};
  };
  constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;
  if (file.size() < 20 || little<std::uint32_t>(file, 0) != kMagic)
    return invalid("not a GLB file");
  if (little<std::uint32_t>(file, 4) != 2) return invalid("GLB of another version than 2");
  if (little<std::uint32_t>(file, 8) != file.size())
    return invalid("GLB of another length than it says");
  const std::size_t json_bytes = little<std::uint32_t>(file, 12);
  if (little<std::uint32_t>(file, 16) != kJson || json_bytes > file.size() - 20 ||
      json_bytes > kMaxJsonBytes)
    return invalid("GLB without a whole JSON chunk");
  const auto rest = file.subspan(20 + json_bytes);
  std::span<const std::uint8_t> binary;
  if (rest.size() >= 8 && little<std::uint32_t>(rest, 4) == kBinary) {
    if (little<std::uint32_t>(rest, 0) > rest.size() - 8)
      return invalid("GLB: the binary chunk is cut off");
    binary = rest.subspan(8, little<std::uint32_t>(rest, 0));
  }
  SLF_TRY(const JsonValue document, parse_json(name, file.subspan(20, json_bytes)));
  return SceneReader(JsonView(document, name), binary, {}).read(warnings);
}

Result<Mesh, InputError> parse_gltf(const std::filesystem::path& file,
                                    std::span<const std::uint8_t> text,
                                    std::vector<std::string>* warnings) {
  SLF_TRY(const JsonValue document, parse_json(file.string(), text));
  std::error_code ignored;
  const auto folder = std::filesystem::absolute(file, ignored).parent_path();
  return SceneReader(JsonView(document, file.string()), {}, folder).read(warnings);
}

}  // namespace slf
