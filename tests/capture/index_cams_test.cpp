// SPDX-License-Identifier: Apache-2.0
// index.cams: the raw surface light fields of Wood et al.
#include <gmock/gmock.h>

#include "capture_formats.h"

namespace slf::index_cams_test {
namespace {

using namespace test;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

std::string ppm() { return "P6\n8 6\n255\n" + std::string(8 * 6 * 3, '\x40'); }

/// How the data may mean a quaternion.
struct Reading {
  bool to_world, backward;
};

/// Four cameras on a circle that look at (1, 2, 3), as `reading` has them.
std::string cams(const Reading& reading, std::vector<Camera>* cameras = nullptr) {
  std::string text = "# name x y z qi qj qk qr cx cy ar f k\n";
  for (int i = 0; i < 4; ++i) {
    const double turn = 1.3 * i;
    const Vec3 eye{1 + 5 * std::cos(turn), 2 + 5 * std::sin(turn), 3.5 + i};
    Vec3 z{1 - eye[0], 2 - eye[1], 3 - eye[2]};
    const double far = std::hypot(z[0], z[1], z[2]);
    for (double& c : z) c /= far;
    const double flat = std::hypot(z[0], z[1]);
    const Vec3 x{z[1] / flat, -z[0] / flat, 0};
    const Vec3 y{z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]};
    std::array<Vec3, 3> r{x, y, z};
    if (cameras != nullptr) {
      cameras->emplace_back();
      cameras->back().rotation = {r[0], r[1], r[2]};
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t j = 0; j < 3; ++j) cameras->back().translation[k] -= r[k][j] * eye[j];
    }
    if (reading.backward)
      for (std::size_t k : {1u, 2u})
        for (double& c : r[k]) c = -c;
    if (reading.to_world)
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < a; ++b) std::swap(r[a][b], r[b][a]);
    // The trace of the matrix may be negative: the largest of the four comes first.
    std::array<double, 4> q{};
    const double trace = r[0][0] + r[1][1] + r[2][2];
    const std::array<double, 4> size{r[0][0], r[1][1], r[2][2], trace};
    const auto most =
        static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
    if (most == 3) {
      q = {r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1], 1 + trace};
    } else {
      const std::size_t b = (most + 1) % 3, c = (most + 2) % 3;
      q[most] = 1 + r[most][most] - r[b][b] - r[c][c];
      q[b] = r[b][most] + r[most][b];
      q[c] = r[c][most] + r[most][c];
      q[3] = r[c][b] - r[b][c];
    }
    double length = 0;
    for (const double c : q) length += c * c;
    char line[200];
    std::snprintf(line, sizeof line, "p%d.ppm %.9g %.9g %.9g %.9g %.9g %.9g %.9g 4 3 1.01 9 0.01\n",
                  i, eye[0], eye[1], eye[2], q[0] / std::sqrt(length), q[1] / std::sqrt(length),
                  q[2] / std::sqrt(length), q[3] / std::sqrt(length));
    text += line;
  }
  return text;
}

Result<Capture, InputError> load(const std::string& index) {
  return load_with([&](const fs::path& p) {
    write_text(p / "index.cams", index);
    for (int i = 0; i < 4; ++i) write_text(p / ("p" + std::to_string(i) + ".ppm"), ppm());
    write_points(p / "mesh_large.ply");
    write_text(p / "few.ply", "ply\n");
  });
}

TEST(IndexCams, AreReadWhicheverWayTheirQuaternionsTurn) {
  for (const bool to_world : {false, true})
    for (const bool backward : {false, true}) {
      std::vector<Camera> expected;
      const auto capture = load(cams({to_world, backward}, &expected));
      ASSERT_TRUE(capture) << capture.error().message;
      ASSERT_EQ(capture->cameras.size(), 4u);
      for (std::size_t i = 0; i < 4; ++i) {
        const Camera& camera = capture->cameras[i];
        for (std::size_t k = 0; k < 3; ++k) {
          EXPECT_NEAR(camera.translation[k], expected[i].translation[k], 1e-6);
          for (std::size_t j = 0; j < 3; ++j)
            EXPECT_NEAR(camera.rotation[k][j], expected[i].rotation[k][j], 1e-6)
                << to_world << backward << i;
        }
        EXPECT_EQ(camera.width, 8);
        EXPECT_EQ(camera.fx, 9);
        EXPECT_NEAR(camera.fy, 9.09, 1e-12);
        EXPECT_EQ(camera.distortion[0], 0.01);
      }
      EXPECT_THAT(capture->warnings,
                  AllOf(Contains(HasSubstr(to_world ? "camera to world" : "world to camera")),
                        Contains(HasSubstr("of 2 meshes the largest, mesh_large.ply"))));
      EXPECT_EQ(capture->cloud.positions.size(), 3u);
    }
}

TEST(IndexCams, DamageNamesTheLine) {
  EXPECT_THAT(message_of(load("p0.ppm 1 2 3\n")), HasSubstr("line 1: name x y z"));
  EXPECT_THAT(message_of(load("\np0.ppm 1 2 3 0 0 0 x 4 3 1 9 0\n")), HasSubstr("line 2: 'x'"));
  EXPECT_THAT(message_of(load("p0.ppm 1 2 3 0 0 0 2 4 3 1 9 0\n")), HasSubstr("no rotation"));
  EXPECT_THAT(message_of(load("p0.ppm 1 2 3 0 0 0 1 4 3 1 0 0\n")), HasSubstr("ar and f"));
  EXPECT_THAT(message_of(load("../p0.ppm 1 2 3 0 0 0 1 4 3 1 9 0\n")), HasSubstr("index.cams"));
  EXPECT_THAT(message_of(load("")), HasSubstr("no cameras"));
}

}  // namespace
}  // namespace slf::index_cams_test
