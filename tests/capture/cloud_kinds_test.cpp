// SPDX-License-Identifier: Apache-2.0
// Clouds as programs of the field write them: other names and ranges, points that are none, normals
// of any side, sparse voxels, strips.
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "capture/density.h"
#include "capture/mesh_sides.h"
#include "capture_support.h"
#include "tests/encoder/sphere_points.h"

namespace slf::cloud_kinds_test {
namespace {

using test::TemporaryDirectory;
using ::testing::AllOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Colour = std::array<std::uint8_t, 3>;

struct Read {
  Mesh mesh;
  std::string error;
  std::vector<std::string> warnings;
};

/// @param rows  of vertices x y z and more
Read read(std::size_t count, const std::string& properties, const std::string& rows,
          const std::string& elements = "") {
  const TemporaryDirectory directory;
  test::write_text(directory / "a.ply",
                   "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) +
                       "\nproperty float x\nproperty float y\nproperty float z\n" + properties +
                       elements + "end_header\n" + rows);
  Read result;
  auto mesh = read_mesh(directory / "a.ply", &result.warnings);
  if (mesh)
    result.mesh = *std::move(mesh);
  else
    result.error = mesh.error().message;
  return result;
}

std::string three(const std::string& type, const std::array<const char*, 3>& names) {
  std::string out;
  for (const char* name : names) out += "property " + type + " " + name + "\n";
  return out;
}

const std::array<const char*, 3> kRgb{"red", "green", "blue"};

TEST(CloudColours, GoByTheNamesOfOtherPrograms) {
  for (const auto& names : {kRgb,
                            {"Red", "Green", "Blue"},
                            {"r", "g", "b"},
                            {"diffuse_red", "diffuse_green", "diffuse_blue"}}) {
    const Read got = read(1, three("uchar", names), "0 0 0 200 120 40\n");
    EXPECT_THAT(got.mesh.vertices.colours, ElementsAre(Colour{200, 120, 40})) << names[0];
    EXPECT_THAT(got.warnings, IsEmpty());
  }
  const Read both =
      read(1, three("uchar", {"r", "g", "b"}) + three("uchar", kRgb), "0 0 0 1 2 3 200 120 40\n");
  EXPECT_THAT(both.mesh.vertices.colours, ElementsAre(Colour{200, 120, 40}));
  // A radius is no red.
  EXPECT_THAT(read(1, "property float r\n", "0 0 0 2\n").warnings,
              ElementsAre(HasSubstr("properties skipped: r")));
}

TEST(CloudColours, HaveTheRangeThatTheyUse) {
  const std::string rows = "0 0 0 0 1 1\n0 0 1 1 1 0\n";
  const auto colours = [&](const char* type, const std::string& last) {
    return read(3, three(type, kRgb), rows + "0 1 0 " + last + "\n").mesh.vertices.colours;
  };
  EXPECT_THAT(colours("ushort", "255 120 40"),
              ElementsAre(Colour{0, 1, 1}, Colour{1, 1, 0}, Colour{255, 120, 40}));
  EXPECT_THAT(colours("ushort", "65535 257 40"),
              ElementsAre(Colour{0, 0, 0}, Colour{0, 0, 0}, Colour{255, 1, 0}));
  EXPECT_THAT(colours("float", "1 0.5 0"),
              ElementsAre(Colour{0, 255, 255}, Colour{255, 255, 0}, Colour{255, 128, 0}));
  EXPECT_THAT(colours("float", "200 0.4 40.4"),
              ElementsAre(Colour{0, 1, 1}, Colour{1, 1, 0}, Colour{200, 0, 40}));
  EXPECT_THAT(read(3, three("float", kRgb), rows + "0 1 0 1.5 0 0\n").error,
              AllOf(HasSubstr("a.ply: colours are floats up to 1.5"), HasSubstr("0 to 1")));
  EXPECT_THAT(read(3, three("float", kRgb), rows + "0 1 0 300 0 0\n").error,
              AllOf(HasSubstr("vertex 2, property red is out of range"), HasSubstr("0 to 255")));
}

TEST(CloudColours, TwelveBitsInSixteenAreWarnedOf) {
  const std::string rows = "0 0 0 0 1 1\n1 0 0 4080 0 0\n";
  const Read twelve = read(2, three("ushort", kRgb), rows);
  EXPECT_THAT(twelve.warnings, ElementsAre(AllOf(HasSubstr("above 4080"),
                                                 HasSubstr("12 bits, multiply them by 16"))));
  EXPECT_THAT(twelve.mesh.vertices.colours[1], ElementsAre(16, 0, 0));
  EXPECT_THAT(read(1, three("ushort", kRgb), "0 0 0 1000 1 1\n").warnings,
              ElementsAre(HasSubstr("10 bits, multiply them by 64")));
  EXPECT_THAT(read(1, three("ushort", kRgb), "0 0 0 4096 1 1\n").warnings, IsEmpty());
}

TEST(CloudPoints, ThatAreNotFiniteAreLeftOutAndCounted) {
  const std::string faces = "element face 2\nproperty list uchar int vertex_indices\n";
  const Read got = read(5, three("uchar", kRgb),
                        "0 0 0 1 1 1\nnan 0 0 2 2 2\n1 0 0 3 3 3\n0 1 -inf 4 4 4\n0 1 0 5 5 5\n"
                        "3 0 2 4\n3 0 1 2\n",
                        faces);
  ASSERT_EQ(got.error, "");
  EXPECT_EQ(got.mesh.vertices.positions.size(), 3u);
  EXPECT_THAT(got.mesh.vertices.colours,
              ElementsAre(Colour{1, 1, 1}, Colour{3, 3, 3}, Colour{5, 5, 5}));
  EXPECT_THAT(got.mesh.triangles, ElementsAre(std::array<std::uint32_t, 3>{0, 1, 2}));
  EXPECT_THAT(got.warnings, ElementsAre(HasSubstr("2 of 5 points are not finite: left out")));
  EXPECT_THAT(read(1, "", "nan nan nan\n").error, HasSubstr("no points"));
  const Read normals = read(2, three("float", {"nx", "ny", "nz"}), "0 0 0 nan 0 0\n1 0 0 0 0 1\n");
  EXPECT_THAT(normals.mesh.vertices.normals, IsEmpty());
  EXPECT_THAT(normals.warnings, ElementsAre(HasSubstr("1 normals have length 0 or are not")));
}

TEST(CloudPoints, NormalsThatAreNoneAreTakenFromNeighboursAndCounted) {
  const std::string normals = three("float", {"nx", "ny", "nz"});
  const Read some =
      read(5, normals, "0 0 0 0 0 1\n1 0 0 0 0 0\n2 0 0 0 0 2\n3 0 0 nan 0 0\n9 0 0 0 1 0\n");
  using Normal = std::array<float, 3>;
  ASSERT_EQ(some.mesh.vertices.normals.size(), 5u);
  EXPECT_EQ(some.mesh.vertices.normals[0], (Normal{0, 0, 1}));
  EXPECT_EQ(some.mesh.vertices.normals[4], (Normal{0, 1, 0}));
  for (const std::size_t i : {std::size_t{1}, std::size_t{3}})
    EXPECT_GT(some.mesh.vertices.normals[i][2], 0.8f) << i;
  EXPECT_THAT(some.warnings,
              ElementsAre(HasSubstr("normals are not of unit length"),
                          AllOf(HasSubstr("2 normals have length 0 or are not finite, of 5"),
                                HasSubstr("neighbours"))));
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  const Read mesh = read(3, normals + face, "0 0 0 0 0 1\n1 0 0 0 0 0\n0 1 0 0 0 1\n3 0 1 2\n");
  EXPECT_THAT(mesh.mesh.vertices.normals, IsEmpty()) << "the faces know better";
  EXPECT_THAT(mesh.warnings, ElementsAre(HasSubstr("normals ignored")));
}

TEST(CloudColours, ColoursOfDirectionsAndOfSplatsAreNamed) {
  std::string properties, row = "0 0 0";
  for (int view = 0; view < 3; ++view)
    for (const char* c : {"red_", "green_", "blue_"}) {
      properties += std::string("property uchar ") + c + std::to_string(view) + "\n";
      row += " 7";
    }
  EXPECT_THAT(
      read(1, properties, row + "\n").warnings,
      ElementsAre(AllOf(HasSubstr("3 more colours of each point"), HasSubstr("plenoptic"))));
  EXPECT_THAT(read(1, "property float f_dc_0\nproperty float opacity\n", "0 0 0 1 1\n").warnings,
              ElementsAre(HasSubstr("Gaussian splats")));
}

TEST(MeshStrips, TurnAboutAndEndAtMinusOne) {
  const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n";
  const Read got = read(5, "", vertices + "8 0 1 2 3 -1 2 3 4\n", strips);
  using Triangle = std::array<std::uint32_t, 3>;
  EXPECT_THAT(got.mesh.triangles,
              ElementsAre(Triangle{0, 1, 2}, Triangle{2, 1, 3}, Triangle{2, 3, 4}));
  EXPECT_THAT(read(5, "", vertices + "3 0 1 -2\n", strips).error, HasSubstr("no vertex"));
  EXPECT_THAT(read(5, "", vertices + "3 0 1 9\n", strips).error, HasSubstr("vertex 9 of 5"));
  EXPECT_THAT(read(5, "", vertices + "3 0 1\n", strips).error, HasSubstr("missing or damaged"));
}

/// A share of the voxels of a surface: whole numbers, no two the same.
PointCloud sparse_voxels(double share, float pitch) {
  std::mt19937 random(7);
  PointCloud cloud;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x)
      if (double(random() % 1000) < share * 1000)
        cloud.positions.push_back({pitch * static_cast<float>(x), pitch * static_cast<float>(y),
                                   pitch * std::floor(static_cast<float>(x) / 3)});
  return cloud;
}

TEST(SparseVoxels, KeepTheirGridAndEveryPoint) {
  for (const double share : {1.0, 0.3, 0.1})
    for (const float pitch : {1.0f, 4.0f}) {
      Capture capture;
      capture.cloud = sparse_voxels(share, pitch);
      const auto voxels = voxelise_geometry(capture, capture.cloud, {}, 0, 0);
      ASSERT_TRUE(voxels) << voxels.error().message;
      EXPECT_EQ(voxels->grid.step, double{pitch}) << share;
      EXPECT_EQ(voxels->merged, 0u);
      EXPECT_EQ(merged_warning(*voxels, capture.cloud.positions.size()), "");
    }
  // Millimetres of a scan are not its grid.
  Capture scan;
  scan.cloud = sparse_voxels(1, 1);
  for (auto& p : scan.cloud.positions) p[0] = 97 * p[0], p[1] = 89 * p[1];
  const auto voxels = voxelise_geometry(scan, scan.cloud, {}, 0, 0);
  ASSERT_TRUE(voxels);
  EXPECT_GT(voxels->grid.step, 20);
  EXPECT_EQ(voxels->merged, 0u);
}

TEST(MergedPoints, AreToldWhereACloudWasToKeepThem) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  Capture capture;
  for (int i = 0; i < 2000; ++i)
    capture.cloud.positions.push_back({uniform(random), uniform(random), 0});
  const auto voxels = voxelise_geometry(capture, capture.cloud, {}, 0, 0);
  ASSERT_TRUE(voxels);
  EXPECT_GT(voxels->merged, 40u);
  EXPECT_THAT(merged_warning(*voxels, 2000),
              AllOf(HasSubstr("of 2000"), HasSubstr("--voxel-size")));
}

/// Cameras all around a unit ball.
std::vector<Camera> around() {
  std::vector<Camera> cameras;
  for (int i = 0; i < 12; ++i) {
    Camera camera = test::camera_at(4, 60);
    const double a = i * 0.5236, c = std::cos(a), s = std::sin(a);
    if (i % 2 == 0)
      camera.rotation = {{{c, 0, -s}, {0, 1, 0}, {s, 0, c}}};
    else
      camera.rotation = {{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
    cameras.push_back(camera);
  }
  return cameras;
}

TEST(CloudNormals, AreTurnedToWhatSeesThem) {
  PointCloud ball;
  ball.positions = ball.normals = sphere(3000).positions;
  const auto outwards = ball.normals;
  EXPECT_EQ(turn_towards(around(), ball), GivenNormals::kOutwards);
  EXPECT_EQ(ball.normals, outwards);
  // One camera sees half of a ball, and no more.
  EXPECT_EQ(turn_towards({test::camera_at(4, 60)}, ball), GivenNormals::kOutwards);
  for (auto& n : ball.normals)
    for (float& x : n) x = -x;
  EXPECT_EQ(turn_towards(around(), ball), GivenNormals::kInwards);
  EXPECT_EQ(ball.normals, outwards);
  std::mt19937 random(1);
  for (auto& n : ball.normals)
    if (random() % 2 == 0)
      for (float& x : n) x = -x;
  EXPECT_EQ(turn_towards(around(), ball), GivenNormals::kEitherWay);
  std::size_t right = 0;
  for (std::size_t i = 0; i < outwards.size(); ++i) right += ball.normals[i] == outwards[i];
  EXPECT_GT(right, outwards.size() * 99 / 100);
}

TEST(CloudNormals, NormalsOfASheetWithTwoSidesAreLeftAsTheyAre) {
  PointCloud sheet;
  for (const float z : {-0.03f, 0.03f})
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 60; ++x) {
        sheet.positions.push_back(
            {0.02f * static_cast<float>(x) - 0.6f, 0.02f * static_cast<float>(y) - 0.6f, z});
        sheet.normals.push_back({0, 0, z < 0 ? -1.0f : 1.0f});
      }
  const auto given = sheet.normals;
  turn_towards({test::camera_at(4, 60)}, sheet);
  EXPECT_EQ(sheet.normals, given);
}

}  // namespace
}  // namespace slf::cloud_kinds_test
