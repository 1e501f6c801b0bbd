// SPDX-License-Identifier: Apache-2.0
// A cube of side 1 about the origin as a mesh file of every format, written by hand.
#pragma once

#include "capture_support.h"

namespace slf::test {

inline constexpr std::array<std::array<float, 3>, 8> kCubeCorners{{{-0.5f, -0.5f, -0.5f},
                                                                   {0.5f, -0.5f, -0.5f},
                                                                   {0.5f, 0.5f, -0.5f},
                                                                   {-0.5f, 0.5f, -0.5f},
                                                                   {-0.5f, -0.5f, 0.5f},
                                                                   {0.5f, -0.5f, 0.5f},
                                                                   {0.5f, 0.5f, 0.5f},
                                                                   {-0.5f, 0.5f, 0.5f}}};
// Counter-clockwise from outside.
inline constexpr std::array<std::array<std::uint8_t, 4>, 6> kCubeFaces{
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {2, 3, 7, 6}, {1, 2, 6, 5}, {0, 4, 7, 3}}};

inline std::string line_of(const std::string& keyword, const std::array<float, 3>& values) {
  std::string line = keyword;
  for (const float x : values) line.append(" ").append(std::to_string(x));
  return line.append("\r\n");
}

inline std::string cube_ply_ascii() {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
      "property float z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& p : kCubeCorners) text.append(line_of("", p));
  for (const auto& f : kCubeFaces) {
    text += "4";
    for (const auto i : f) text.append(" ").append(std::to_string(i));
    text += "\n";
  }
  return text;
}

/// Faces first, with a property of their own before the indices.
inline std::string cube_ply_binary(bool big_endian) {
  ByteString out;
  out.text(std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
           "_endian 1.0\nelement face 6\nproperty uchar flags\n"
           "property list uchar ushort vertex_index\nelement vertex 8\nproperty double x\n"
           "property double y\nproperty double z\nend_header\n");
  for (const auto& f : kCubeFaces) {
    out.put('\7').put('\4');
    for (const auto i : f) out.put(std::uint16_t{i}, big_endian);
  }
  for (const auto& p : kCubeCorners)
    for (const float x : p) out.put(double{x}, big_endian);
  return out.bytes;
}

inline std::string cube_obj() {
  std::string text = "# a cube\r\nmtllib no.mtl\no cube\n";
  for (const auto& p : kCubeCorners) text.append(line_of("v", p));
  text += "vt 0 0\nusemtl paint\ns off\n";
  for (const auto& f : kCubeFaces) {
    text += "f";
    for (const auto i : f)  // back from the last
      text.append(" ").append(std::to_string(i - 8)).append("/1");
    text += "\n";
  }
  return text;
}

/// Two triangles of every face; normals of the file are wrong on purpose.
template <class Triangle>
void for_each_cube_triangle(const Triangle& triangle) {
  for (const auto& f : kCubeFaces)
    for (const std::size_t k : std::initializer_list<std::size_t>{1, 2})
      triangle(std::array{kCubeCorners[f[0]], kCubeCorners[f[k]], kCubeCorners[f[k + 1]]});
}

/// @param title  of its header: some begin with "solid"
inline std::string cube_stl_binary(const std::string& title = "a cube") {
  ByteString out;
  out.text(title + std::string(80 - title.size(), '\0')).put(std::uint32_t{12});
  for_each_cube_triangle([&](const auto& corners) {
    out.put(0.0f).put(0.0f).put(1.0f);
    for (const auto& corner : corners)
      for (const float x : corner) out.put(x);
    out.put(std::uint16_t{0});
  });
  return out.bytes;
}

inline std::string cube_stl_ascii() {
  std::string text = "solid cube\r\n";
  for_each_cube_triangle([&](const auto& corners) {
    text += "facet normal 0 0 1\n outer loop\n";
    for (const auto& corner : corners) text += line_of("  vertex", corner);
    text += " endloop\nendfacet\n";
  });
  return text + "endsolid cube\n";
}

inline std::string glb_of(std::string json, std::string binary) {
  while (json.size() % 4 != 0) json += ' ';
  while (binary.size() % 4 != 0) binary += '\0';
  ByteString out;
  out.text("glTF").put(std::uint32_t{2});
  out.put(static_cast<std::uint32_t>(28 + json.size() + binary.size()));
  out.put(static_cast<std::uint32_t>(json.size())).text("JSON").text(json);
  out.put(static_cast<std::uint32_t>(binary.size())).text("BIN").put('\0').text(binary);
  return out.bytes;
}

/// Corners times two about (1, 2, 3), which its nodes take back.
inline const std::string kCubeGltf = R"({"asset": {"version": "2.0"}, "scene": 0,
 "scenes": [{"nodes": [1]}],
 "nodes": [{"mesh": 0, "scale": [0.5, 0.5, 0.5]},
           {"children": [0], "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, -0.5,-1,-1.5,1]}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3"},
               {"bufferView": 1, "componentType": 5121, "count": 36, "type": "SCALAR"}],
 "bufferViews": [{"buffer": 0, "byteLength": 128, "byteStride": 16},
                 {"buffer": 0, "byteOffset": 128, "byteLength": 36}],
 "buffers": [{"byteLength": 164}]})";

inline std::string cube_glb_binary() {
  ByteString out;
  for (const auto& p : kCubeCorners) {
    out.put(2 * p[0] + 1).put(2 * p[1] + 2).put(2 * p[2] + 3);
    out.put(0.0f);  // of the stride
  }
  for (const auto& f : kCubeFaces)
    for (const std::size_t i : std::initializer_list<std::size_t>{0, 1, 2, 0, 2, 3}) out.put(f[i]);
  return out.bytes;
}

inline std::string cube_glb(const std::string& json = kCubeGltf) {
  return glb_of(json, cube_glb_binary());
}

/// The corners of cube_glb by Draco 1.5.5 with 8 bits: edgebreaker and sequential.
inline constexpr std::array<const char*, 2> kCubeDraco{
    "445241434f02020101000000080c000b0000035f4b0b01011001ff000001000903000002010101010103552d0108ad"
    "0a068c35750a338300000000ff000000000000000000803f000000400000004008",
    "445241434f0202010000000c0801000102000203040506040607000305000504020107020706030206030605000407"
    "000701010100090300000200010100030301280118030010b2501029120000000000ff000000000000000000803f00"
    "0000400000004008"};

inline std::string from_hex(const std::string& digits) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
    bytes += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
  return bytes;
}

/// Corners and indices are in the buffer, compressed; accessors say how many.
inline std::string cube_glb_draco(const std::string& draco, const std::string& corners = "8") {
  const std::string size = std::to_string(draco.size());
  const std::string json = R"({"asset": {"version": "2.0"}, "scene": 0,
 "extensionsRequired": ["KHR_draco_mesh_compression"], "scenes": [{"nodes": [0]}],
 "nodes": [{"mesh": 0, "scale": [0.5, 0.5, 0.5], "translation": [-0.5, -1, -1.5]}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "extensions":
  {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}}]}],
 "accessors": [{"componentType": 5126, "count": )" +
                           corners + R"(, "type": "VEC3"},
               {"componentType": 5123, "count": 36, "type": "SCALAR"}],
 "bufferViews": [{"buffer": 0, "byteLength": )" +
                           size + R"(}], "buffers": [{"byteLength": )" + size + "}]}";
  return glb_of(json, draco);
}

inline Result<Mesh, InputError> mesh_in(const std::string& name, const std::string& bytes) {
  const TemporaryDirectory directory;
  write_text(directory / name, bytes);
  return read_mesh(directory / name);
}

inline double signed_volume(const Mesh& mesh) {
  double six = 0;
  for (const auto& t : mesh.triangles) {
    const auto &a = mesh.vertices.positions[t[0]], &b = mesh.vertices.positions[t[1]],
               &c = mesh.vertices.positions[t[2]];
    six += double{a[0]} * (b[1] * c[2] - b[2] * c[1]) + double{a[1]} * (b[2] * c[0] - b[0] * c[2]) +
           double{a[2]} * (b[0] * c[1] - b[1] * c[0]);
  }
  return six / 6;
}

}  // namespace slf::test
