// Meshes: what files give, what is refused, and what a grid makes of them.
#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "capture/density.h"
#include "capture/mesh_sampling.h"
#include "mesh_files.h"

namespace slf {
namespace {

using namespace test;
using ::testing::HasSubstr;

Result<Mesh, InputError> mesh_in(const std::string& name, const std::string& bytes) {
  const TemporaryDirectory directory;
  write_text(directory / name, bytes);
  return read_mesh(directory / name);
}

void expect_refused(const std::string& name, const std::string& bytes, const std::string& cause) {
  const auto mesh = mesh_in(name, bytes);
  ASSERT_FALSE(mesh) << cause;
  EXPECT_THAT(mesh.error().message, HasSubstr(name));
  EXPECT_THAT(mesh.error().message, HasSubstr(cause));
}

Mesh cube() { return *mesh_in("cube.obj", cube_obj()); }

Grid grid_of(const Mesh& mesh, double step) { return *choose_grid(bounding_box(mesh), 3, 0, step); }

double signed_volume(const Mesh& mesh) {
  double six = 0;
  for (const auto& t : mesh.triangles) {
    const auto &a = mesh.vertices.positions[t[0]], &b = mesh.vertices.positions[t[1]],
               &c = mesh.vertices.positions[t[2]];
    six += double{a[0]} * (b[1] * c[2] - b[2] * c[1]) + double{a[1]} * (b[2] * c[0] - b[0] * c[2]) +
           double{a[2]} * (b[0] * c[1] - b[1] * c[0]);
  }
  return six / 6;
}

struct Format {
  const char *name, *file;
  std::string bytes;
};

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

TEST(MeshFile, AMirroringNodeKeepsTheOutsideOut) {
  const auto mesh =
      mesh_in("a.glb", cube_glb(replaced(kCubeGltf, "[0.5, 0.5, 0.5]", "[-0.5, 0.5, 0.5]")));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_NEAR(signed_volume(*mesh), 1, 1e-6);
}

TEST(SampleMesh, ACubeBecomesItsOuterVoxelsEachOnce) {
  const Mesh mesh = cube();
  const Grid grid = grid_of(mesh, 0.125);  // 9 voxels along a side
  const auto points = sample_mesh(mesh, grid);
  ASSERT_TRUE(points) << points.error().message;
  const VoxelCloud voxels = voxelise_on(*points, grid);
  EXPECT_EQ(voxels.positions.size(), 9u * 9 * 9 - 7 * 7 * 7);
}

/// z = 0.3 x + 0.2 y over the unit square, as n x n x 2 triangles.
Mesh slope(std::size_t n) {
  Mesh mesh;
  for (std::size_t j = 0; j <= n; ++j)
    for (std::size_t i = 0; i <= n; ++i) {
      const float x = static_cast<float>(i) / static_cast<float>(n),
                  y = static_cast<float>(j) / static_cast<float>(n);
      mesh.vertices.positions.push_back({x, y, 0.3f * x + 0.2f * y});
    }
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (n + 1) + i),
                 b = a + static_cast<std::uint32_t>(n) + 1;
      mesh.triangles.push_back({a, a + 1, b});
      mesh.triangles.push_back({b, a + 1, b + 1});
    }
  return mesh;
}

TEST(SampleMesh, ALayerIsOneVoxelThickWithoutHolesHoweverFineTheTriangles) {
  for (const std::size_t n : std::initializer_list<std::size_t>{1, 7, 300}) {
    const Mesh mesh = slope(n);
    const Grid grid = grid_of(mesh, 1.0 / 64);
    const auto points = sample_mesh(mesh, grid);
    ASSERT_TRUE(points) << points.error().message;
    const VoxelCloud voxels = voxelise_on(*points, grid);
    std::set<std::pair<int, int>> columns;
    for (const Voxel& v : voxels.positions) columns.emplace(v[0], v[1]);
    EXPECT_EQ(columns.size(), 65u * 65) << n;
    EXPECT_EQ(voxels.positions.size(), 65u * 65) << n;
  }
}

TEST(SampleMesh, PointsLieOnTheSurfaceWithItsNormal) {
  const Mesh mesh = slope(3);
  const auto points = sample_mesh(mesh, grid_of(mesh, 1.0 / 32));
  ASSERT_TRUE(points) << points.error().message;
  const double length = std::sqrt(1 + 0.09 + 0.04);
  for (std::size_t i = 0; i < points->positions.size(); ++i) {
    const auto& p = points->positions[i];
    EXPECT_NEAR(double{p[2]}, 0.3 * double{p[0]} + 0.2 * double{p[1]}, 1e-5);
    EXPECT_NEAR(double{points->normals[i][2]}, 1 / length, 1e-5);
  }
}

TEST(SampleMesh, TrianglesWithoutAreaGiveNothing) {
  Mesh mesh;
  mesh.vertices.positions = {{0, 0, 0}, {1, 1, 1}, {0.5f, 0.5f, 0.5f}};
  mesh.triangles = {{0, 1, 2}, {0, 0, 0}, {1, 1, 0}};
  const auto points = sample_mesh(mesh, grid_of(mesh, 0.1));
  ASSERT_TRUE(points) << points.error().message;
  EXPECT_TRUE(points->positions.empty());
}

TEST(SampleMesh, AStepThatTakesTooManyPointsIsRefusedBeforeItBegins) {
  const Mesh mesh = cube();
  const auto points = sample_mesh(mesh, grid_of(mesh, 1e-5));
  ASSERT_FALSE(points);
  EXPECT_THAT(points.error().message, HasSubstr("voxel size"));
}

Camera camera_at(double z, double focal) {
  Camera camera;  // looks along +z from (0, 0, -z)
  camera.width = camera.height = 64;
  camera.fx = camera.fy = focal;
  camera.cx = camera.cy = 32;
  camera.translation = {0, 0, z};
  return camera;
}

TEST(SampleMesh, FacesThatPointInwardsAreTurned) {
  Mesh mesh = cube();
  const std::vector<Camera> cameras{camera_at(4, 64)};
  EXPECT_FALSE(turn_towards(cameras, mesh));
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_TRUE(turn_towards(cameras, mesh));
  EXPECT_NEAR(signed_volume(mesh), 1, 1e-6);
}

/// n x n points of the square [-0.5, 0.5] at z = 0, which camera_at faces.
Capture square(int n, std::vector<Camera> cameras) {
  Capture capture;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      capture.cloud.positions.push_back({static_cast<float>(i) / static_cast<float>(n - 1) - 0.5f,
                                         static_cast<float>(j) / static_cast<float>(n - 1) - 0.5f,
                                         0});
      capture.cloud.normals.push_back({0, 0, -1});
    }
  capture.cameras = std::move(cameras);
  return capture;
}

TEST(Density, IsThePixelOfTheSharpestCameraThatFacesThePoints) {
  Camera behind = camera_at(1, 400);
  behind.rotation = {{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};  // the other side, closest of all
  const Capture capture = square(200, {camera_at(8, 64), camera_at(4, 64), behind});
  const std::vector<int> all{0, 1, 2}, far{0};
  const Density density = choose_density(capture, all);
  EXPECT_NEAR(density.pixel, 4.0 / 64, 1e-9);
  EXPECT_NEAR(density.voxel_size, kPixelsPerVoxel * density.pixel, 1e-9);
  EXPECT_FALSE(density.limited_by_cloud);
  EXPECT_NEAR(choose_density(capture, far).pixel, 8.0 / 64, 1e-9) << "only the input cameras count";
}

TEST(Density, IsNoFinerThanTheCloud) {
  const Capture capture = square(11, {camera_at(4, 640)});
  const std::vector<int> all{0};
  const Density density = choose_density(capture, all);
  EXPECT_TRUE(density.limited_by_cloud);
  EXPECT_NEAR(density.spacing, 0.1, 1e-6);
  EXPECT_GT(density.voxel_size, 0.04);
  EXPECT_LT(density.voxel_size, 0.1);
  const auto voxels = voxelise_geometry(capture, capture.cloud, all, 0, 0);
  ASSERT_TRUE(voxels) << voxels.error().message;
  EXPECT_EQ(voxels->positions.size(), 121u) << "no point is lost";
  EXPECT_EQ(voxels->density.voxel_size, voxels->grid.step);
}

TEST(Density, ADenseCloudBecomesALayerOneVoxelThickWithoutHoles) {
  Capture capture;
  constexpr int kSide = 700;  // points along a side; about 21 along that of a voxel
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const double x = double(i) / (kSide - 1), y = double(j) / (kSide - 1);
      capture.cloud.positions.push_back(
          {static_cast<float>(x), static_cast<float>(y), static_cast<float>(0.35 * x + 0.45 * y)});
      const double length = std::sqrt(1 + 0.35 * 0.35 + 0.45 * 0.45);
      capture.cloud.normals.push_back({static_cast<float>(0.35 / length),
                                       static_cast<float>(0.45 / length),
                                       static_cast<float>(-1 / length)});
    }
  capture.cameras = {camera_at(4, 160)};  // 0.025 a pixel
  const std::vector<int> all{0};
  const auto voxels = voxelise_geometry(capture, capture.cloud, all, 0, 0);
  ASSERT_TRUE(voxels) << voxels.error().message;
  ASSERT_FALSE(voxels->density.limited_by_cloud);
  std::set<std::pair<int, int>> columns;
  for (const Voxel& v : voxels->positions) columns.emplace(v[0], v[1]);
  const double cells = 1 / voxels->grid.step;
  const auto side = static_cast<std::size_t>(std::floor(cells + 0.5)) + 1;
  EXPECT_EQ(columns.size(), side * side) << "no hole";
  EXPECT_LE(voxels->positions.size(), side * side * 101 / 100) << "hardly a column has two";
  EXPECT_EQ(voxels->merged + voxels->positions.size(), capture.cloud.positions.size());
  EXPECT_EQ(voxels->normals.size(), voxels->positions.size());
}

TEST(Density, ACloudOfVoxelsStaysWhatItIs) {
  Capture capture;
  for (int j = 0; j < 40; ++j)
    for (int i = 0; i < 40; ++i)
      capture.cloud.positions.push_back(
          {static_cast<float>(i), static_cast<float>(j), static_cast<float>((i + j) / 2)});
  const auto voxels = voxelise_geometry(capture, capture.cloud, {}, 0, 0);
  ASSERT_TRUE(voxels) << voxels.error().message;
  EXPECT_EQ(voxels->grid.step, 1);
  EXPECT_EQ(voxels->merged, 0u);
}

TEST(Density, GivenNumbersAreKept) {
  const Capture capture = square(50, {camera_at(4, 640)});
  const std::vector<int> all{0};
  EXPECT_EQ(voxelise_geometry(capture, capture.cloud, all, 7, 0)->grid.bits, 7);
  EXPECT_EQ(voxelise_geometry(capture, capture.cloud, all, 0, 0.03)->grid.step, 0.03);
}

TEST(Density, OnePointAndCoincidingPointsAreWhatTheyWere) {
  Capture capture;
  capture.cloud.positions = {{1, 2, 3}};
  ASSERT_TRUE(voxelise_geometry(capture, capture.cloud, {}, 0, 0));
  capture.cloud.positions.push_back({1, 2, 3});
  const auto voxels = voxelise_geometry(capture, capture.cloud, {}, 0, 0);
  ASSERT_FALSE(voxels);
  EXPECT_THAT(voxels.error().message, HasSubstr("one voxel"));
}

TEST(MeshCapture, IsSampledAtItsPhotographsDensityAndAgainOnAnotherGrid) {
  const TemporaryDirectory directory;
  const Image image{64, 64, 3, std::vector<std::uint8_t>(64 * 64 * 3, 90)};
  std::filesystem::create_directories(directory / "images");
  ASSERT_TRUE(write_png(directory / "images/a.png", image));
  write_text(directory / "mesh.glb", cube_glb());
  write_text(directory / "cameras.json", R"({"cameras": [{"image": "images/a.png", "width": 64,
    "height": 64, "K": [[64, 0, 32], [0, 64, 32], [0, 0, 1]],
    "R": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "t": [0, 0, 2]}]})");
  const auto capture = load_capture(directory.path());
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_EQ(capture->mesh.triangles.size(), 12u);
  EXPECT_EQ(capture->cloud.normals.size(), capture->cloud.positions.size());
  const std::vector<int> all{0};
  const Density density = choose_density(*capture, all);
  EXPECT_EQ(density.spacing, 0) << "a surface has points anywhere";
  EXPECT_NEAR(density.pixel, 1.5 / 64, 1e-6) << "of the one face that is seen";
  const auto finer = voxelise_geometry(*capture, capture->cloud, all, 8, 0);
  ASSERT_TRUE(finer) << finer.error().message;
  EXPECT_EQ(finer->positions.size(), 256u * 256 * 256 - 254u * 254 * 254);
}

}  // namespace
}  // namespace slf
