// SPDX-License-Identifier: Apache-2.0
// Files of meshes: what they give, and what is refused.
#include <gmock/gmock.h>

#include "capture/mesh_triangles.h"
#include "mesh_files.h"

namespace slf::mesh_file_test {
namespace {

using namespace test;
using ::testing::HasSubstr;

void expect_refused(const std::string& name, const std::string& bytes, const std::string& cause) {
  const auto mesh = mesh_in(name, bytes);
  ASSERT_FALSE(mesh) << cause;
  EXPECT_THAT(mesh.error().message, HasSubstr(name));
  EXPECT_THAT(mesh.error().message, HasSubstr(cause));
}

struct Format {
  const char *name, *file;
  std::string bytes;
};
void PrintTo(const Format& format, std::ostream* out) { *out << format.name; }

class MeshFormat : public testing::TestWithParam<Format> {};

TEST_P(MeshFormat, GivesTheSameClosedCubeWithItsOutsideOut) {
  const auto mesh = mesh_in(GetParam().file, GetParam().bytes);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 12u);
  EXPECT_NEAR(signed_volume(*mesh), 1, 1e-6);
  const Box box = bounding_box(*mesh);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(box.min[k], -0.5, 1e-6);
    EXPECT_NEAR(box.max[k], 0.5, 1e-6);
  }
}

TEST_P(MeshFormat, EveryTruncationIsAnErrorOrASmallerMesh) {
  const TemporaryDirectory directory;
  const std::string& whole = GetParam().bytes;
  for (std::size_t size = 0; size < whole.size(); size += 3) {
    write_text(directory / GetParam().file, whole.substr(0, size));
    const auto mesh = read_mesh(directory / GetParam().file);
    if (!mesh) {
      EXPECT_THAT(mesh.error().message, HasSubstr(GetParam().file));
      continue;
    }
    EXPECT_LE(mesh->triangles.size(), 12u);
    for (const auto& t : mesh->triangles)
      for (const auto v : t) ASSERT_LT(v, mesh->vertices.positions.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, MeshFormat,
                         testing::Values(Format{"ply_ascii", "cube.ply", cube_ply_ascii()},
                                         Format{"ply_little", "cube.ply", cube_ply_binary(false)},
                                         Format{"ply_big", "cube.ply", cube_ply_binary(true)},
                                         Format{"obj", "cube.OBJ", cube_obj()},
                                         Format{"stl_binary", "cube.stl", cube_stl_binary()},
                                         Format{"stl_ascii", "cube.STL", cube_stl_ascii()},
                                         Format{"glb", "cube.glb", cube_glb()}),
                         [](const auto& tested) { return tested.param.name; });

TEST(MeshFile, PlyFacesThatAreWrongAreNamed) {
  const std::string cube = cube_ply_ascii();
  expect_refused("a.ply", replaced(cube, "4 0 3 2 1", "4 0 3 2 8"), "vertex 8 of 8");
  expect_refused("a.ply", replaced(cube, "4 0 3 2 1", "4 0 3 2 -1"), "face 0");
  expect_refused("a.ply", replaced(cube, "4 4 5 6 7", "4 4 5 6.5 7"), "face 1");
  expect_refused("a.ply", replaced(cube, "list uchar int", "list uchar float"), "vertex_indices");
  expect_refused("a.ply", replaced(cube, "vertex_indices", "colours"), "vertex_indices");
  expect_refused("a.ply", replaced(cube, "face 6", "face 60000"), "more than the file holds");
}

TEST(MeshFile, FacesOfFewerThanThreeCornersAreNoTriangles) {
  const auto mesh = mesh_in("a.ply", replaced(cube_ply_ascii(), "4 0 3 2 1", "2 0 3"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 10u);
}

TEST(MeshFile, ObjCoordinatesThatFloatsCannotHoldAreGivenFromAnOriginNearby) {
  const auto mesh = mesh_in("a.obj",
                            "v 400000.001 5700000.002 0\nv 400001.004 5700000 0\n"
                            "v 400000 5700001.25 0.5\nf 1 2 3\n");
  ASSERT_TRUE(mesh) << mesh.error().message;
  const PointCloud& vertices = mesh->vertices;
  EXPECT_EQ(vertices.origin, (Vec3{400000, 5700000, 0}));
  EXPECT_EQ(vertices.positions[1][1], 0);
  EXPECT_NEAR(vertices.positions[0][0], 0.001, 1e-8);
  EXPECT_NEAR(vertices.positions[0][1], 0.002, 1e-8);
  EXPECT_EQ(vertices.positions[2][1], 1.25f);
}

TEST(MeshFile, ObjErrorsNameTheLine) {
  expect_refused("a.obj", "v 0 0 0\nv 1 0\n", "line 2");
  expect_refused("a.obj", "v 0 0 nan\n", "vertex 0");
  expect_refused("a.obj", "v 0 0 1e99\n", "line 1");
  expect_refused("a.obj", "v 0 0 0\nf 1 1\n", "line 2");
  expect_refused("a.obj", "v 0 0 0\nf 1 1 0\n", "line 2");
  expect_refused("a.obj", "v 0 0 0\nf 1 1 -2\n", "line 2");
  expect_refused("a.obj", "v 0 0 0\nf 1 1 99999999999\n", "line 2");
  expect_refused("a.obj", "v 0 0 0\nf 1 1 x\n", "line 2");
  expect_refused("a.obj", "v 0 0 0\nf 1 1 2\n", "triangle 0");
  expect_refused("a.obj", "", "no points");
}

TEST(MeshFile, ObjNormalsBelongToCornersAndAnUnusableOneDropsAll) {
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 0 0 2\nvn 0 1 1\n"
      "f 1//1 2//1 3//1\nf 3//2 2//1 4//1\n";
  const auto mesh = mesh_in("a.obj", text);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->vertices.positions.size(), 5u) << "vertex 3 has two normals";
  EXPECT_EQ(mesh->vertices.normals[0], (std::array<float, 3>{0, 0, 1}));
  const auto without = mesh_in("a.obj", replaced(text, "0 0 2", "0 0 0"));
  ASSERT_TRUE(without) << without.error().message;
  EXPECT_TRUE(without->vertices.normals.empty());
}

TEST(MeshFile, GlbErrorsNameThePlace) {
  const auto with = [](const char* from, const char* to) {
    return cube_glb(replaced(kCubeGltf, from, to));
  };
  expect_refused("a.glb", with("\"count\": 8", "\"count\": 9"), "accessors[0]");
  expect_refused("a.glb", with("\"count\": 8", "\"count\": 4294967295"), "accessors[0]");
  expect_refused("a.glb", with("\"count\": 8", "\"count\": 7"), "index");
  expect_refused("a.glb", with("\"byteOffset\": 128", "\"byteOffset\": 4000000000"),
                 "bufferViews[1]");
  expect_refused("a.glb", with("\"byteStride\": 16", "\"byteStride\": 4"), "byteStride");
  expect_refused("a.glb", with("5126", "5127"), "componentType");
  expect_refused("a.glb", with("{\"byteLength\": 164}", "{\"byteLength\": 164, \"uri\": \"x\"}"),
                 "buffers[0]");
  expect_refused("a.glb", with("\"children\": [0]", "\"children\": [1]"), "nodes[1]");
  expect_refused("a.glb", with("\"children\": [0]", "\"children\": [2]"), "children[0]");
  expect_refused("a.glb", with("\"scene\": 0", "\"scene\": 1"), "scene");
  expect_refused("a.glb", with("\"asset\"", "\"extensionsRequired\": [\"KHR_draco\"], \"asset\""),
                 "extensionsRequired[0]");
  expect_refused("a.glb", with("0.5, 0.5, 0.5", "1e300, 0.5, 0.5"), "not finite");
  expect_refused("a.glb", "glTF", "not a GLB file");
  std::string long_chunk = cube_glb();
  long_chunk[long_chunk.size() - 164 - 8] = static_cast<char>(164 + 8);
  expect_refused("a.glb", long_chunk, "binary chunk");
}

/// A cube `primitives` times in a mesh that as many nodes have.
std::string shared_cubes(int nodes, int primitives) {
  const std::string cube = R"({"attributes": {"POSITION": 0}, "indices": 1})";
  std::string roots = "0", all = "{\"mesh\": 0}", cubes = cube;
  for (int i = 1; i < nodes; ++i) roots += ", " + std::to_string(i), all += ", {\"mesh\": 0}";
  for (int i = 1; i < primitives; ++i) cubes += ", " + cube;
  const std::string rest = kCubeGltf.substr(kCubeGltf.find(" \"accessors\""));
  return cube_glb(R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [)" + roots +
                  "]}], \"nodes\": [" + all + "], \"meshes\": [{\"primitives\": [" + cubes +
                  "]}],\n" + rest);
}

TEST(MeshFile, WhatNodesShareIsBoundedByTheBytesOfTheFile) {
  const auto some = mesh_in("a.glb", shared_cubes(100, 100));
  ASSERT_TRUE(some) << some.error().message;
  EXPECT_EQ(some->triangles.size(), 120'000u);
  expect_refused("a.glb", shared_cubes(300, 300), "is used too often");
}

TEST(MeshFile, AMirroringNodeKeepsTheOutsideOut) {
  const auto mesh =
      mesh_in("a.glb", cube_glb(replaced(kCubeGltf, "[0.5, 0.5, 0.5]", "[-0.5, 0.5, 0.5]")));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_NEAR(signed_volume(*mesh), 1, 1e-6);
}

// "AAEC" and so on, of the buffer of the cube.
std::string base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned bits = 0;
  int held = 0;
  for (const char c : bytes) {
    bits = bits << 8 | static_cast<unsigned char>(c);
    for (held += 8; held >= 6; held -= 6) out += digits[bits >> (held - 6) & 63];
  }
  if (held > 0) out += digits[bits << (6 - held) & 63];
  while (out.size() % 4 != 0) out += '=';
  return out;
}

std::string with_uri(const std::string& uri) {
  return replaced(kCubeGltf, "\"byteLength\": 164",
                  "\"byteLength\": 164, \"uri\": \"" + uri + "\"");
}

TEST(MeshFile, BuffersOfGltfAreInTheFileOrBesideIt) {
  const std::string data = "data:application/octet-stream;base64," + base64(cube_glb_binary());
  for (const char* name : {"a.glb", "a.gltf"}) {
    const bool glb = std::string(name) == "a.glb";
    const auto mesh = mesh_in(name, glb ? glb_of(with_uri(data), "") : with_uri(data));
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_NEAR(signed_volume(*mesh), 1, 1e-6);
  }
  const TemporaryDirectory directory;
  write_text(directory / "a b.bin", cube_glb_binary());
  write_text(directory / "a.gltf", with_uri("a%20b.bin"));
  const auto mesh = read_mesh(directory / "a.gltf");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_NEAR(signed_volume(*mesh), 1, 1e-6);
  expect_refused("a.gltf", with_uri("../a.bin"), "leads out");
  EXPECT_THAT(mesh_in("a.gltf", with_uri("none.bin")).error().message, HasSubstr("none.bin: No"));
  expect_refused("a.gltf", with_uri("data:;base64,A"), "buffers[0].uri: a data URI");
  expect_refused("a.gltf", with_uri("data:;base64,AA=A"), "a data URI");
  expect_refused("a.gltf", with_uri("data:;base64,AAAA"), "beyond its buffer");
  expect_refused("a.gltf", kCubeGltf, "bufferViews[0]");
}

TEST(MeshFile, AGlbOfPointsIsACloud) {
  const auto points = replaced(kCubeGltf, "\"indices\": 1", "\"mode\": 0");
  const auto mesh = mesh_in("a.glb", cube_glb(points));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_TRUE(mesh->triangles.empty());
  ASSERT_EQ(mesh->vertices.positions.size(), 8u);
  EXPECT_EQ(mesh->vertices.positions[0], mesh_in("a.glb", cube_glb())->vertices.positions[0]);
  EXPECT_FALSE(mesh_in("a.glb", cube_glb(replaced(points, "\"mode\": 0", "\"mode\": 1"))));
}

TEST(MeshFile, CompressionAndOtherFormatsAreNamedWithAWayOut) {
  const auto glb = cube_glb(replaced(
      kCubeGltf, "\"asset\"", "\"extensionsRequired\": [\"EXT_meshopt_compression\"], \"asset\""));
  expect_refused("a.glb", glb, "EXT_meshopt_compression");
  expect_refused("a.glb", glb, "without compression");
  expect_refused("a.fbx", "x", "export the mesh as PLY, OBJ or GLB");
}

TEST(MeshFile, CornersOfAnStlThatAgreeAreOneVertex) {
  for (const std::string& stl : {cube_stl_binary("solid of a program"),
                                 replaced(cube_stl_ascii(), "-0.500000", "-5.0e-1")}) {
    const auto mesh = mesh_in("a.stl", stl);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->vertices.positions.size(), 8u);
    EXPECT_TRUE(mesh->vertices.normals.empty());
  }
}

TEST(MeshFile, StlThatIsWrongIsNamedWithItsPlace) {
  std::string nan = cube_stl_binary();
  nan.replace(84 + 50 * 3 + 12, 4, ByteString().put(std::nanf("")).bytes);
  expect_refused("a.stl", nan, "facet 3: a corner is not finite");
  expect_refused("a.stl", cube_stl_binary() + "x", "no STL");
  expect_refused("a.stl", replaced(cube_stl_ascii(), "-0.500000", "-0,500000"), "line 4");
  expect_refused("a.stl", replaced(cube_stl_ascii(), " endloop", "  vertex 1 2 3\n endloop"),
                 "three vertices");
  expect_refused("a.stl", "solid nothing\nendsolid\n", "no points");
}

#if SLF_WITH_DRACO
TEST(MeshFile, DracoInAGlbGivesTheSameClosedCube) {
  for (const char* digits : kCubeDraco) {
    const auto mesh = mesh_in("a.glb", cube_glb_draco(from_hex(digits)));
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->triangles.size(), 12u);
    EXPECT_EQ(mesh->vertices.positions.size(), 8u);
    EXPECT_NEAR(signed_volume(*mesh), 1, 1e-6);
    EXPECT_NEAR(bounding_box(*mesh).min[0], -0.5, 1e-6);
  }
}

TEST(MeshFile, DracoInAGlbIsHeldAgainstItsAccessorsAndItsBytes) {
  for (const char* digits : kCubeDraco) {
    const std::string draco = from_hex(digits);
    expect_refused("a.glb", cube_glb_draco(draco, "7"), "more faces or points than the accessors");
    std::string other = draco;
    other[7] = 0;
    expect_refused("a.glb", cube_glb_draco(other), "KHR_draco_mesh_compression: no mesh of Draco");
    for (std::size_t at = 0; at < draco.size(); ++at) {
      EXPECT_FALSE(mesh_in("a.glb", cube_glb_draco(draco.substr(0, at))));
      for (const int value : {0, 1, 127, 255}) {
        other = draco;
        other[at] = static_cast<char>(value);
        const auto mesh = mesh_in("a.glb", cube_glb_draco(other));
        EXPECT_TRUE(!mesh || mesh->triangles.size() <= 12);
      }
    }
  }
}
#endif

}  // namespace
}  // namespace slf::mesh_file_test
