// SPDX-License-Identifier: Apache-2.0
// A cloud with points far away: what is said, and what --crop leaves of it.
#include "capture/crop.h"
#include "slf/crop_gaussians.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "base/quaternion.h"
#include "capture_support.h"
#include "tests/lightfield/gaussian_support.h"

namespace slf::crop_test {
namespace {

using ::testing::HasSubstr;

/// 1,000 points of a unit cube, colours their numbers.
PointCloud cube() {
  PointCloud cloud;
  for (int i = 0; i < 1000; ++i) {
    const int x = i % 10, y = i / 10 % 10, z = i / 100;
    cloud.positions.push_back({float(x) / 9, float(y) / 9, float(z) / 9});
    cloud.colours.push_back({std::uint8_t(i % 250), 0, 0});
  }
  return cloud;
}

/// The box that a warning names.
WorldBox box_of(const std::string& warning) {
  WorldBox b;
  const auto at = warning.find("--crop=");
  EXPECT_NE(at, std::string::npos) << warning;
  if (at == std::string::npos) return b;
  EXPECT_EQ(std::sscanf(warning.c_str() + at, "--crop=%lf,%lf,%lf,%lf,%lf,%lf", &b.low[0],
                        &b.low[1], &b.low[2], &b.high[0], &b.high[1], &b.high[2]),
            6);
  return b;
}

TEST(FarPoints, OneIsNamedWithABoxThatLeavesAllOthers) {
  Mesh mesh{cube(), {}};
  EXPECT_EQ(far_points_warning(mesh.vertices, {0, 0, 0}), "");
  mesh.vertices.positions.push_back({0, 900, 0});
  mesh.vertices.colours.push_back({1, 2, 3});
  const std::string warning = far_points_warning(mesh.vertices, {0, 0, 0});
  EXPECT_THAT(warning, HasSubstr("900 times"));
  ASSERT_TRUE(crop(mesh, {0, 0, 0}, box_of(warning)));
  EXPECT_EQ(mesh.vertices.positions, cube().positions);
  EXPECT_EQ(mesh.vertices.colours, cube().colours);
}

TEST(FarPoints, BoxesAreOfTheWorldAndKeepItsDigits) {
  const Vec3 origin{4500000.25, 600000.5, 100};
  Mesh mesh{cube(), {}};
  mesh.vertices.positions.push_back({-500, 0, 0});
  mesh.vertices.colours.push_back({1, 2, 3});
  ASSERT_TRUE(crop(mesh, origin, box_of(far_points_warning(mesh.vertices, origin))));
  EXPECT_EQ(mesh.vertices.positions, cube().positions);
}

TEST(FarPoints, SmallAndFlatCloudsAreLeftInPeace) {
  PointCloud few = cube();
  few.positions.resize(50);
  few.positions.push_back({1000, 0, 0});
  EXPECT_EQ(far_points_warning(few, {0, 0, 0}), "");
  PointCloud one;
  one.positions.assign(1000, {1, 2, 3});
  EXPECT_EQ(far_points_warning(one, {0, 0, 0}), "");
  PointCloud line;  // long, but all along
  for (int i = 0; i < 1000; ++i) line.positions.push_back({float(i), 0, 0});
  EXPECT_EQ(far_points_warning(line, {0, 0, 0}), "");
}

/// 1,000 splats of the cube, as large as their spacing.
Gaussians splats_of_cube() {
  Gaussians splats;
  splats.positions = cube().positions;
  splats.log_deviations.assign(1000, {-3, -3, -3});
  splats.rotations.assign(1000, {1, 0, 0, 0});
  splats.logits.assign(1000, 1);
  for (int i = 0; i < 3000; ++i) splats.harmonics.push_back(float(i));
  return splats;
}

TEST(FarSplats, OneIsNamedWithABoxThatLeavesAllOthers) {
  const Gaussians cube = splats_of_cube();
  EXPECT_EQ(far_splats_warning(cube), "");
  for (const float far : {1e6f, 1e30f}) {
    Gaussians splats = splats_of_cube();
    splats.positions[500][1] = far;
    const std::string warning = far_splats_warning(splats);
    EXPECT_THAT(warning, HasSubstr("a few splats far away"));
    ASSERT_TRUE(crop(splats, box_of(warning)));
    EXPECT_EQ(splats.size(), 999u);
    EXPECT_EQ(splats.positions[500], cube.positions[501]);
    EXPECT_EQ(splats.harmonics[1500], cube.harmonics[1503]);
  }
}

TEST(FarSplats, ThatNoGridLosesAnythingForAreLeftInPeace) {
  Gaussians splats = splats_of_cube();
  splats.positions[500][1] = 1000;  // 21 bits of it are finer than a splat by far
  EXPECT_EQ(far_splats_warning(splats), "");
  EXPECT_FALSE(crop(splats, {{5, 5, 5}, {6, 6, 6}}));
}

TEST(Crop, KeepsFacesByTheirCentroidsAndRefusesAnEmptyBox) {
  Mesh mesh;
  mesh.vertices.positions = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {30, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 2, 3}};
  Mesh other = mesh;
  ASSERT_TRUE(crop(mesh, {0, 0, 0}, {{2, 2, 1}, {0, 0, -1}}));  // corners in any order
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}}));
  const auto nothing = crop(other, {0, 0, 0}, {{50, 50, 50}, {60, 60, 60}});
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, Errc::kInvalidInput);
}

TEST(Crop, IsPartOfLoadingACaptureWhichElseWarns) {
  const test::TemporaryDirectory directory;
  PointCloud cloud = cube();
  cloud.positions.push_back({0, 0, 700});
  cloud.colours.push_back({1, 2, 3});
  ASSERT_TRUE(write_ply(directory / "a.ply", cloud));
  const auto whole = load_capture(directory / "a.ply");
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->cloud.positions.size(), 1001u);
  EXPECT_THAT(whole->warnings, ::testing::Contains(HasSubstr("far away")));
  CaptureOptions options;
  options.crop = box_of(whole->warnings.back());
  const auto cropped = load_capture(directory / "a.ply", options);
  ASSERT_TRUE(cropped);
  EXPECT_EQ(cropped->cloud.positions.size(), 1000u);
  EXPECT_TRUE(cropped->warnings.empty());
}

Matrix3x3 covariance_of(const Gaussians& splats, std::size_t p) {
  Matrix3x3 m = rotation_of(splats.rotations[p]), out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k)
        out[i][j] += m[i][k] * m[j][k] * std::exp(2 * double{splats.log_deviations[p][k]});
  return out;
}

TEST(GaussiansInAnotherWorld, LieAndStretchWhereTheirPointsGo) {
  for (const char* text : {"x,-z,y,2,1,0,-3", "-x,y,z", "z,y,x,0.5"}) {
    const WorldChange change = *parse_world_change(text);
    const Gaussians before = test::random_gaussians(20, 2);
    Gaussians after = before;
    change_world(change, after);
    const auto point = [](const std::array<float, 3>& v) {
      return Vec3{double{v[0]}, double{v[1]}, double{v[2]}};
    };
    const Vec3 zero = change.apply({0, 0, 0});
    for (std::size_t p = 0; p < before.size(); ++p) {
      const Vec3 expected = change.apply(point(before.positions[p]));
      const Matrix3x3 own = covariance_of(before, p), got = covariance_of(after, p);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(after.positions[p][i], expected[i], 1e-4) << text;
        for (std::size_t j = 0; j < 3; ++j) {
          double moved = 0;  // of the axes that become i and j
          for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t b = 0; b < 3; ++b) {
              Vec3 x{}, y{};
              x[a] = y[b] = 1;
              moved += (change.apply(x)[i] - zero[i]) * (change.apply(y)[j] - zero[j]) * own[a][b];
            }
          EXPECT_NEAR(got[i][j], moved, 1e-4 * (own[0][0] + own[1][1] + own[2][2])) << text;
        }
      }
    }
  }
}

}  // namespace
}  // namespace slf::crop_test
