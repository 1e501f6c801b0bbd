// SPDX-License-Identifier: Apache-2.0
// LAS without PDAL: every point format, its coordinates and colours, and what is refused.
#include <gmock/gmock.h>

#include "capture/las_reader.h"
#include "capture_formats.h"

namespace slf::las_test {
namespace {

using namespace test;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::array<std::pair<std::size_t, std::size_t>, 11> kRecords{
    {{20, 0},
     {28, 0},
     {26, 20},
     {34, 28},
     {57, 0},
     {63, 28},
     {30, 0},
     {36, 30},
     {38, 30},
     {59, 0},
     {67, 30}}};  // bytes, and where the colour is
const std::string kWkt = "PROJCS[\"UTM 32N\",UNIT[\"metre\",1]]";

struct Las {
  std::uint8_t minor = 2, format = 2;
  std::uint16_t extra = 0;     // bytes behind each record
  std::uint16_t colour = 257;  // times 200, 120, 40
  std::string user = "LASF_Projection";
  std::uint16_t record = 2112;

  /// Three points of millimetres from a place on a map, and a record of the coordinate system.
  std::string bytes() const {
    const bool wide = minor == 4;
    const std::uint16_t header_bytes = wide ? 375 : 227;
    const auto [record_bytes, colour_at] = kRecords[format];
    ByteString vlr;
    vlr.put(std::uint16_t{0}).text(user + std::string(16 - user.size(), '\0')).put(record);
    vlr.put(static_cast<std::uint16_t>(kWkt.size() + 1)).text(std::string(32, '\0'));
    vlr.text(kWkt).put('\0');
    ByteString out;
    out.text("LASF").text(std::string(20, '\0')).put('\1').put(minor).text(std::string(68, '\0'));
    out.put(header_bytes).put(static_cast<std::uint32_t>(header_bytes + vlr.bytes.size()));
    out.put(std::uint32_t{1}).put(format).put(static_cast<std::uint16_t>(record_bytes + extra));
    out.put(std::uint32_t{wide ? 0u : 3u}).text(std::string(20, '\0'));
    for (int k = 0; k < 3; ++k) out.put(0.001);
    out.put(400000.0).put(5700000.0).put(100.0).text(std::string(48, '\0'));
    if (wide) out.text(std::string(20, '\0')).put(std::uint64_t{3}).text(std::string(120, '\0'));
    out.text(vlr.bytes);
    for (const auto& p : kPoints) {
      std::string point(record_bytes + extra, '\x55');
      const ByteString place = ByteString().put(p[0]).put(p[1]).put(p[2]);
      point.replace(0, 12, place.bytes);
      ByteString rgb;
      for (const int c : {200, 120, 40}) rgb.put(static_cast<std::uint16_t>(c * colour));
      if (colour_at > 0) point.replace(colour_at, 6, rgb.bytes);
      out.text(point);
    }
    return out.bytes;
  }
  static constexpr std::array<std::array<std::int32_t, 3>, 3> kPoints{
      {{0, 0, 0}, {1500, -250, 1}, {2000000, 7, 1000}}};
};

Result<Scan, InputError> read(const std::string& bytes, std::vector<std::string>* warnings) {
  const TemporaryDirectory directory;
  write_text(directory / "a.las", bytes);
  return read_scan(directory / "a.las", warnings);
}

std::string refusal(std::string bytes, std::size_t at, const std::string& with) {
  const auto scan = read(bytes.replace(at, with.size(), with), nullptr);
  return scan ? "accepted" : scan.error().message;
}

TEST(Las, EveryPointFormatGivesTheSamePoints) {
  for (const std::uint8_t minor : {std::uint8_t{2}, std::uint8_t{4}})
    for (std::size_t format = 0; format < kRecords.size(); ++format)
      for (const std::uint16_t extra : {std::uint16_t{0}, std::uint16_t{5}}) {
        std::vector<std::string> warnings;
        const auto scan =
            read(Las{minor, static_cast<std::uint8_t>(format), extra}.bytes(), &warnings);
        ASSERT_TRUE(scan) << scan.error().message;
        EXPECT_THAT(warnings, IsEmpty());
        EXPECT_EQ(scan->crs, kWkt);
        const PointCloud& cloud = scan->points.vertices;
        ASSERT_EQ(cloud.positions.size(), 3u);
        EXPECT_NEAR(cloud.origin[0] + double{cloud.positions[1][0]}, 400001.5, 1e-4);
        EXPECT_NEAR(cloud.origin[1] + double{cloud.positions[1][1]}, 5699999.75, 1e-4);
        EXPECT_NEAR(cloud.origin[2] + double{cloud.positions[2][2]}, 101, 1e-4);
        ASSERT_EQ(cloud.colours.size(), kRecords[format].second == 0 ? 0u : 3u);
        for (const auto& colour : cloud.colours) EXPECT_THAT(colour, ElementsAre(200, 120, 40));
      }
}

TEST(Las, ColoursOfEightBitsInSixteenAreNotBlack) {
  std::vector<std::string> warnings;
  const auto scan = read(Las{.colour = 1}.bytes(), &warnings);
  ASSERT_TRUE(scan) << scan.error().message;
  EXPECT_THAT(scan->points.vertices.colours[0], ElementsAre(200, 120, 40));
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("read as 8 bits")));
}

TEST(Las, ASystemOfGeoTiffKeysIsNoticed) {
  std::vector<std::string> warnings;
  const auto scan = read(Las{.record = 34735}.bytes(), &warnings);
  ASSERT_TRUE(scan) << scan.error().message;
  EXPECT_EQ(scan->crs, "");
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("--crs FILE")));
}

TEST(Las, WhatIsWrongIsNamedWithItsElement) {
  const std::string las = Las{}.bytes();
  EXPECT_THAT(refusal(las, 25, "\5"), AllOf(HasSubstr("a.las"), HasSubstr("LAS 1.5")));
  EXPECT_THAT(refusal(las, 104, "\13"), HasSubstr("point data format 11"));
  EXPECT_THAT(refusal(las, 105, "\24"), HasSubstr("record length"));
  EXPECT_THAT(refusal(las, 107, "\4"), HasSubstr("number of points: 4 are not in the file"));
  EXPECT_THAT(refusal(las, 96, std::string("\0\0", 2)), HasSubstr("offset to point data"));
  EXPECT_THAT(refusal(las, 94, "\xFF\xFF"), HasSubstr("header size"));
  EXPECT_THAT(refusal(las, 131, std::string(8, '\0')), HasSubstr("scale or offset of axis 0"));
  EXPECT_THAT(refusal(las, 104, "\x82"), HasSubstr("PDAL"));  // LAZ, where there is no PDAL
}

// Every prefix and every changed byte of the header is points or an error, under sanitizers.
TEST(Las, NoByteOfItsHeaderLeadsOutOfTheFile) {
  for (const std::uint8_t minor : {std::uint8_t{2}, std::uint8_t{4}}) {
    const std::string whole = Las{minor, minor}.bytes();
    const TemporaryDirectory directory;
    for (std::size_t at = 0; at < whole.size(); ++at) {
      write_text(directory / "a.las", whole.substr(0, at));
      EXPECT_FALSE(is_plain_las(directory / "a.las") && read_las(directory / "a.las", nullptr));
      for (const int value : {0, 1, 127, 255}) {
        std::string changed = whole;
        changed[at] = static_cast<char>(value);
        write_text(directory / "a.las", changed);
        const auto scan = read_las(directory / "a.las", nullptr);
        EXPECT_TRUE(!scan || scan->points.vertices.positions.size() <= 3);
      }
    }
  }
}

}  // namespace
}  // namespace slf::las_test
