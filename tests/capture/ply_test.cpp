// SPDX-License-Identifier: Apache-2.0
// PLY: what is read by name, what is refused, what comes back.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "capture_support.h"

namespace slf::ply_test {
namespace {

using test::ByteString;
using test::TemporaryDirectory;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Position = std::array<float, 3>;
using Colour = std::array<std::uint8_t, 3>;

Result<PointCloud, InputError> read(const std::string& text,
                                    std::vector<std::string>* warnings = nullptr) {
  const TemporaryDirectory directory;
  test::write_text(directory / "cloud.ply", text);
  return read_ply(directory / "cloud.ply", warnings);
}

TEST(PlyReader, ReadsAsciiPropertiesInAnyOrderAndSkipsOthersWithOneWarning) {
  std::vector<std::string> warnings;
  const auto cloud = read(
      "ply\r\nformat ascii 1.0\r\ncomment by hand\r\nobj_info none\r\n"
      "element camera 1\r\nproperty list uchar float values\r\n"
      "element vertex 2\r\nproperty double z\r\nproperty uchar blue\r\nproperty float "
      "confidence\r\n"
      "property list uchar int around\r\nproperty int x\r\nproperty uchar red\r\n"
      "property uchar green\r\nproperty float y\r\n"
      "element face 1\r\nproperty list uchar int vertex_indices\r\nend_header\r\n"
      "3 9 9 9\r\n"
      "1.5 30 0.1 2 7 8 -4 10 20 +2.25\r\n"
      "-1e2 33 0.1 0 5 11 22 .5\r\n"
      "2 0 1\r\n",
      &warnings);
  ASSERT_TRUE(cloud) << cloud.error().message;
  EXPECT_THAT(cloud->positions, ElementsAre(Position{-4, 2.25f, 1.5f}, Position{5, 0.5f, -100}));
  EXPECT_THAT(cloud->colours, ElementsAre(Colour{10, 20, 30}, Colour{11, 22, 33}));
  EXPECT_TRUE(cloud->normals.empty());
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("confidence, around")));
}

TEST(PlyReader, AByteOrderMarkIsNoPartOfTheFile) {
  const std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex 1\n";
  const std::string properties =
      "property float x\nproperty float y\nproperty float z\nend_header\n";
  ByteString file;
  file.text("\xEF\xBB\xBF" + header + properties).put(1.0f).put(2.0f).put(3.0f);
  const auto cloud = read(file.bytes);
  ASSERT_TRUE(cloud) << cloud.error().message;
  EXPECT_THAT(cloud->positions, ElementsAre(Position{1, 2, 3}));
}

// One vertex with every scalar type, in either byte order.
std::string every_type(bool big) {
  ByteString file;
  file.text("ply\nformat ").text(big ? "binary_big_endian" : "binary_little_endian").text(" 1.0\n");
  file.text("element before 2\nproperty list ushort double values\nproperty char c\n");
  file.text("element vertex 1\nproperty short x\nproperty uint y\nproperty double z\n");
  file.text("property float nx\nproperty char ny\nproperty int nz\n");
  file.text("property ushort red\nproperty float green\nproperty uchar blue\n");
  file.text("property list uint short tail\nend_header\n");
  file.put(std::uint16_t{1}, big).put(7.0, big).put(std::int8_t{1});
  file.put(std::uint16_t{0}, big).put(std::int8_t{1});
  file.put(std::int16_t{-300}, big).put(std::uint32_t{4000000000u}, big).put(0.125, big);
  file.put(0.0f, big).put(std::int8_t{-3}, big).put(std::int32_t{4}, big);
  file.put(std::uint16_t{65535}, big).put(0.5f, big).put(std::uint8_t{9}, big);
  file.put(std::uint32_t{2}, big).put(std::int16_t{1}, big).put(std::int16_t{2}, big);
  return file.bytes;
}

class PlyByteOrder : public testing::TestWithParam<bool> {};

TEST_P(PlyByteOrder, EveryScalarTypeIsReadAndColoursAreScaled) {
  std::vector<std::string> warnings;
  const auto cloud = read(every_type(GetParam()), &warnings);
  ASSERT_TRUE(cloud) << cloud.error().message;
  EXPECT_THAT(cloud->positions, ElementsAre(Position{-300, 4e9f, 0.125f}));
  EXPECT_THAT(cloud->colours, ElementsAre(Colour{255, 128, 9}));  // 65535 / 257; round(127.5)
  ASSERT_EQ(cloud->normals.size(), 1u);  // (0, -3, 4) is not of unit length
  EXPECT_FLOAT_EQ(cloud->normals[0][1], -0.6f);
  EXPECT_FLOAT_EQ(cloud->normals[0][2], 0.8f);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("tail"), HasSubstr("normalised")));
}

TEST_P(PlyByteOrder, EveryTruncationIsAnError) {
  const std::string whole = every_type(GetParam());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto cloud = read(whole.substr(0, size));
    ASSERT_FALSE(cloud) << size << " of " << whole.size() << " bytes";
    EXPECT_EQ(cloud.error().code, Errc::kInvalidInput);
    EXPECT_THAT(cloud.error().message, HasSubstr("cloud.ply: "));
  }
}
INSTANTIATE_TEST_SUITE_P(Orders, PlyByteOrder, testing::Bool(),
                         [](const auto& order) { return order.param ? "big" : "little"; });

const std::string kHeader =
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "end_header\n";

struct Refused {
  const char* name;
  std::string text;
  const char* cause;
};
void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.name; }
class PlyRefused : public testing::TestWithParam<Refused> {};

TEST_P(PlyRefused, WithFileAndCause) {
  const auto cloud = read(GetParam().text);
  ASSERT_FALSE(cloud);
  EXPECT_EQ(cloud.error().code, Errc::kInvalidInput);
  EXPECT_THAT(cloud.error().message, HasSubstr("cloud.ply: "));
  EXPECT_THAT(cloud.error().message, HasSubstr(GetParam().cause));
}
INSTANTIATE_TEST_SUITE_P(
    Causes, PlyRefused,
    testing::Values(
        Refused{"other_file", "solid cube\n", "not a PLY"}, Refused{"empty", "", "not a PLY"},
        Refused{"no_end", "ply\nformat ascii 1.0\n", "without an end"},
        Refused{"version", test::replaced(kHeader, "1.0", "2.0") + "0 0 0 1 1 1\n",
                "not understood"},
        Refused{"no_format", test::replaced(kHeader, "format ascii 1.0\n", "") + "0 0 0 1 1 1\n",
                "without a format"},
        Refused{"unknown_type", test::replaced(kHeader, "float y", "half y") + "0 0 0 1 1 1\n",
                "property half y"},
        Refused{"no_z", test::replaced(kHeader, "float z", "float w") + "0 0 0 1 1 1\n",
                "without x, y and z"},
        Refused{"property_twice", test::replaced(kHeader, "float z", "float x") + "0 0 0 1 1 1\n",
                "'x' twice"},
        Refused{"no_vertices", "ply\nformat ascii 1.0\nend_header\n", "without vertices"},
        Refused{"zero_points", test::replaced(kHeader, "vertex 2", "vertex 0"), "no points"},
        Refused{"float_overflow",
                test::replaced(kHeader, "float x", "double x") + "0 0 0 1e39 1 1\n",
                "vertex 1, property x is beyond 3.4e38"},
        Refused{"no_number", kHeader + "0 0 0 1 1 one\n",
                "vertex 1, property z is missing or damaged"},
        Refused{"too_few", kHeader + "0 0 0 1 1\n", "vertex 1, property z is missing"},
        Refused{"negative_count", test::replaced(kHeader, "vertex 2", "vertex -2"), "vertex -2"},
        Refused{"count_beyond_file",
                test::replaced(kHeader, "vertex 2", "vertex 18446744073709551615"),
                "more than the file holds"},
        Refused{"faces_beyond_file",
                test::replaced(kHeader, "end_header",
                               "element face 99\nproperty list int int i\nend_header") +
                    "0 0 0 1 1 1\n",
                "more than the file holds"},
        Refused{
            "colour_range",
            test::replaced(kHeader, "end_header",
                           "property int red\nproperty int green\nproperty int blue\nend_header") +
                "0 0 0 1 2 3 1 1 1 4 256 6\n",
            "vertex 1, property green is out of range"}),
    [](const auto& refused) { return refused.param.name; });

// Metres on a map, structure of a millimetre.
const std::string kFarPoints =
    "400000.001 5700000.002 100.5 400000.004 5700001.25 100.003 399999.999 5700000.5 99.75\n";

std::string far_header(const char* type) {
  std::string header = test::replaced(kHeader, "vertex 2", "vertex 3");
  for (const char* axis : {"x", "y", "z"})
    header = test::replaced(header, std::string("float ") + axis, std::string(type) + " " + axis);
  return header;
}

TEST(PlyReader, DoublesThatFloatsCannotHoldAreGivenFromAnOriginNearby) {
  const auto cloud = read(far_header("double") + kFarPoints);
  ASSERT_TRUE(cloud) << cloud.error().message;
  EXPECT_EQ(cloud->origin, (Vec3{399999, 5700000, 99}));
  const std::array<Vec3, 3> expected{{{400000.001, 5700000.002, 100.5},
                                      {400000.004, 5700001.25, 100.003},
                                      {399999.999, 5700000.5, 99.75}}};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(cloud->origin[k] + double{cloud->positions[i][k]}, expected[i][k], 2e-7);
}

TEST(PlyReader, FloatsAreReadAsTheyAre) {
  const auto cloud = read(far_header("float") + kFarPoints);
  ASSERT_TRUE(cloud) << cloud.error().message;
  EXPECT_EQ(cloud->origin, (Vec3{0, 0, 0}));
  EXPECT_THAT(cloud->positions, ElementsAre(Position{400000.001f, 5700000.002f, 100.5f},
                                            Position{400000.004f, 5700001.25f, 100.003f},
                                            Position{399999.999f, 5700000.5f, 99.75f}));
}

TEST(PlyReader, DoublesThatFloatsHoldAreFromZero) {
  for (const char* points : {"0.1 0.2 0.3 1 -1 0.7 0 0 0\n",           // near zero for their extent
                             "5700001 7 3 5700002 8 4 5700003 1 1\n",  // whole numbers
                             "0.1 0.2 0.3 0.1 0.2 0.3 0.1 0.2 0.3\n"}) {
    const auto cloud = read(far_header("double") + points);
    ASSERT_TRUE(cloud) << cloud.error().message;
    EXPECT_EQ(cloud->origin, (Vec3{0, 0, 0})) << points;
  }
}

TEST(PlyReader, ExtentsThatAreNoneOrTinyHaveAnOriginThatIsFinite) {
  for (const char* points :
       {"0 1e30 0.1 1e-320 1e30 0.1 0 1e30 0.1\n", "1e-320 0 0 1e-310 0 0 0 0 0\n",
        "5700000.001 1 2 5700000.001 1 2 5700000.001 1 2\n", "3e38 -3e38 0 -3e38 3e38 1 1 1 1\n"}) {
    const auto cloud = read(far_header("double") + points);
    ASSERT_TRUE(cloud) << cloud.error().message;
    for (const double x : cloud->origin) EXPECT_TRUE(std::isfinite(x)) << points;
    for (const auto& p : cloud->positions)
      for (const float x : p) EXPECT_TRUE(std::isfinite(x)) << points;
  }
}

TEST(PlyReader, ZeroLengthNormalsMakeAllNormalsUnusable) {
  std::vector<std::string> warnings;
  const auto cloud =
      read(test::replaced(kHeader, "end_header",
                          "property float nx\nproperty float ny\nproperty float nz\nend_header") +
               "0 0 0 0 0 1  1 1 1 0 0 0\n",
           &warnings);
  ASSERT_TRUE(cloud);
  EXPECT_TRUE(cloud->normals.empty());
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("1 normals have length 0")));
}

TEST(PlyReader, MissingFileIsUnreadable) {
  const TemporaryDirectory directory;
  const auto cloud = read_ply(directory / "none.ply");
  ASSERT_FALSE(cloud);
  EXPECT_EQ(cloud.error().code, Errc::kUnreadable);
  EXPECT_THAT(cloud.error().message, HasSubstr("none.ply"));
}

TEST(PlyWriter, WhatIsWrittenIsReadBack) {
  PointCloud cloud;
  cloud.positions = {{0.5f, -1e-30f, 3e30f}, {1, 2, 3}};
  cloud.normals = {{0, 0, 1}, {0.6f, 0, -0.8f}};
  cloud.colours = {{0, 128, 255}, {1, 2, 3}};
  const TemporaryDirectory directory;
  ASSERT_TRUE(write_ply(directory / "cloud.ply", cloud));
  const auto back = read_ply(directory / "cloud.ply");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->positions, cloud.positions);
  EXPECT_EQ(back->normals, cloud.normals);
  EXPECT_EQ(back->colours, cloud.colours);
  EXPECT_THAT(test::read_text(directory / "cloud.ply"),
              HasSubstr("format binary_little_endian 1.0\nelement vertex 2\nproperty float x\n"));
}

TEST(PlyWriter, PositionsFromAnOriginAreWrittenAsDoubles) {
  PointCloud cloud;
  cloud.origin = {400000, 5700000, 100};
  cloud.positions = {{0.001f, 0.002f, 0}, {1, 0.5f, 0.25f}};
  const TemporaryDirectory directory;
  ASSERT_TRUE(write_ply(directory / "cloud.ply", cloud));
  const auto back = read_ply(directory / "cloud.ply");
  ASSERT_TRUE(back) << back.error().message;
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(back->origin[k] - cloud.origin[k] + double{back->positions[i][k]},
                  double{cloud.positions[i][k]}, 1e-8);
}

TEST(PlyWriter, ArraysOfDifferentLengthAreRefused) {
  PointCloud cloud;
  cloud.positions = {{0, 0, 0}, {1, 1, 1}};
  cloud.normals = {{0, 0, 1}};
  const TemporaryDirectory directory;
  const auto written = write_ply(directory / "cloud.ply", cloud);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::kInvalidArgument);
  EXPECT_EQ(directory.num_entries(), 0u);
}

}  // namespace
}  // namespace slf::ply_test
