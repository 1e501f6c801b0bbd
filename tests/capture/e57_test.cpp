// SPDX-License-Identifier: Apache-2.0
// E57 without PDAL: every kind of column, poses, spherical coordinates, pages, and what is refused.
#include "capture/e57_reader.h"

#include <gmock/gmock.h>

#include <cmath>

#include "capture/e57_file.h"
#include "capture_formats.h"

namespace slf::e57_test {
namespace {

using namespace test;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::size_t kPage = 128, kPayload = kPage - 4;  // small, so that all runs over its end

/// CRC-32C bit by bit.
std::uint32_t crc(const std::string& bytes) {
  std::uint32_t value = ~0u;
  for (const char byte : bytes) {
    value ^= static_cast<std::uint8_t>(byte);
    for (int bit = 0; bit < 8; ++bit) value = value >> 1 ^ ((value & 1) != 0 ? 0x82F63B78u : 0u);
  }
  return ~value;
}

/// Whole pages, each with its checksum.
std::string paged(std::string logical) {
  logical.resize((logical.size() + kPayload - 1) / kPayload * kPayload);
  std::string out;
  for (std::size_t at = 0; at < logical.size(); at += kPayload) {
    const std::string page = logical.substr(at, kPayload);
    out += page + ByteString{}.put(crc(page), true).bytes;
  }
  return out;
}

std::uint64_t physical(std::uint64_t logical) {
  return logical / kPayload * kPage + logical % kPayload;
}

/// Values of `bits` each, the lowest bit first.
std::string packed(const std::vector<std::uint64_t>& values, std::size_t bits) {
  std::string out((values.size() * bits + 7) / 8, '\0');
  for (std::size_t i = 0; i < values.size() * bits; ++i)
    if ((values[i / bits] >> i % bits & 1) != 0)
      out[i / 8] = static_cast<char>(out[i / 8] | 1 << i % 8);
  return out;
}

/// A compressed vector at this logical offset: columns in packets of `each` bytes a column.
std::string section(std::uint64_t at, const std::vector<std::string>& columns, std::size_t each) {
  ByteString packets;
  packets.text(std::string("\x02\0\x03\0", 4));  // an empty one
  for (std::size_t from = 0;; from += each) {
    ByteString lengths, data;
    for (const std::string& column : columns) {
      const std::string piece = from < column.size() ? column.substr(from, each) : "";
      lengths.put(std::uint16_t(piece.size()));
      data.text(piece);
    }
    if (data.bytes.empty()) break;
    while ((6 + lengths.bytes.size() + data.bytes.size()) % 4 != 0) data.put('\0');
    packets.text(std::string("\1\0", 2));
    packets.put(std::uint16_t(5 + lengths.bytes.size() + data.bytes.size()));
    packets.put(std::uint16_t(columns.size())).text(lengths.bytes + data.bytes);
  }
  ByteString out;
  out.text(std::string("\1\0\0\0\0\0\0\0", 8)).put(std::uint64_t{32 + packets.bytes.size()});
  return out.put(physical(at + 32)).put(std::uint64_t{0}).text(packets.bytes).bytes;
}

struct Cloud {
  std::string prototype;
  std::vector<std::string> columns;
  std::size_t rows = 0;
  std::string more = {};  // XML
};

std::string e57(const std::vector<Cloud>& clouds, const std::string& more = "",
                const std::string& more_clouds = "") {
  std::string body(48, '\0');
  std::string xml =
      "<?xml version=\"1.0\"?><e57Root type=\"Structure\"><guid><![CDATA[{<&}]]></guid>" + more +
      "<data3D type=\"Vector\">";
  for (const Cloud& cloud : clouds) {
    xml += "<vectorChild type=\"Structure\">" + cloud.more +
           "<points type=\"CompressedVector\" fileOffset=\"" +
           std::to_string(physical(body.size())) + "\" recordCount=\"" +
           std::to_string(cloud.rows) + "\"><prototype>" + cloud.prototype +
           "</prototype></points></vectorChild>";
    body += section(body.size(), cloud.columns, 5);
  }
  xml += more_clouds + "</data3D></e57Root>";
  const std::uint64_t at = body.size(), pages = (at + xml.size() + kPayload - 1) / kPayload;
  ByteString head;
  head.text("ASTM-E57").put(std::uint32_t{1}).put(std::uint32_t{0}).put(pages * kPage);
  head.put(physical(at)).put(std::uint64_t{xml.size()}).put(std::uint64_t{kPage});
  return paged(head.bytes + body.substr(48) + xml);
}

template <class T>
std::string floats(const std::vector<T>& values) {
  ByteString out;
  for (const T value : values) out.put(value);
  return out.bytes;
}

/// Integers of 19 bits in tenths less 30000, on which no value begins at a byte.
Cloud scaled_cloud(std::size_t rows = 9) {
  const std::string axis =
      " type=\"ScaledInteger\" minimum=\"-100\" maximum=\"524187\" scale=\"0.5\" "
      "offset=\"1.0e+1\"/>";
  const std::string colour = " type=\"Integer\" minimum=\"0\" maximum=\"1023\"/>";
  Cloud cloud{"<cartesianX" + axis + "<cartesianY" + axis + "<cartesianZ" + axis + "<colorRed" +
                  colour + "<colorGreen" + colour + "<colorBlue" + colour,
              {},
              rows};
  for (const std::uint64_t k : {0u, 1u, 2u}) {
    std::vector<std::uint64_t> stored;
    for (std::uint64_t p = 0; p < rows; ++p) stored.push_back(100 + 40 * p + 2000 * k * p);
    cloud.columns.push_back(packed(stored, 19));
  }
  for (const std::uint64_t k : {0u, 1u, 2u}) {
    std::vector<std::uint64_t> stored;
    for (std::uint64_t p = 0; p < rows; ++p) stored.push_back(k == 2 ? 1023 : 100 * p);
    cloud.columns.push_back(packed(stored, 10));
  }
  return cloud;
}

Cloud spherical_cloud() {
  const double turn = std::acos(0.0);
  return {
      "<sphericalRange type=\"Float\"/><sphericalAzimuth type=\"Float\"/><sphericalElevation "
      "type=\"Float\" precision=\"double\"/><sphericalInvalidState type=\"Integer\" minimum=\"0\" "
      "maximum=\"2\"/><colorRed type=\"Integer\" minimum=\"7\" maximum=\"7\"/><colorGreen "
      "type=\"Float\" precision=\"single\"/><colorBlue type=\"Float\" precision=\"single\"/>",
      {floats<double>({2, 2, 3, 5}), floats<double>({0, turn, 0, 0}),
       floats<double>({0, 0, turn, std::nan("")}), packed({0, 0, 2, 0}, 2), "",
       floats<float>({0, 1, 0, 0}), floats<float>({0.5f, 1, 0, 0})},
      4};
}

Result<Scan, InputError> read(const std::string& bytes,
                              std::vector<std::string>* warnings = nullptr) {
  const TemporaryDirectory directory;
  write_text(directory / "a.e57", bytes);
  return read_scan(directory / "a.e57", warnings);
}

std::string refusal(const std::string& bytes) {
  const auto scan = read(bytes);
  return scan ? "accepted" : scan.error().message;
}

TEST(E57, IntegersOfAnyNumberOfBitsRunOverPacketsAndPages) {
  std::vector<std::string> warnings;
  const auto scan = read(e57({scaled_cloud()}), &warnings);
  ASSERT_TRUE(scan) << scan.error().message;
  EXPECT_THAT(warnings, IsEmpty());
  const PointCloud& cloud = scan->points.vertices;
  ASSERT_EQ(cloud.positions.size(), 9u);
  for (std::size_t p = 0; p < 9; ++p) {
    const auto n = float(p);
    EXPECT_THAT(cloud.positions[p], ElementsAre(10 + 20 * n, 10 + 1020 * n, 10 + 2020 * n)) << p;
    const int red = int(std::lround(25500.0 * double(p) / 1023));
    EXPECT_THAT(cloud.colours[p], ElementsAre(red, red, 255)) << p;
  }
}

TEST(E57, SphericalPointsAreTurnedByTheirPoseAndThoseNotMeasuredLeftOut) {
  Cloud cloud = spherical_cloud();
  cloud.more =
      "<pose><rotation><w type=\"Float\">1</w><x type=\"Float\"/><z type=\"Float\">1</z></rotation>"
      "<translation><x type=\"Float\">100</x></translation></pose>";
  std::vector<std::string> warnings;
  const auto scan = read(e57({cloud, scaled_cloud()}), &warnings);
  ASSERT_TRUE(scan) << scan.error().message;
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("2 points were not measured")));
  const PointCloud& points = scan->points.vertices;
  ASSERT_EQ(points.positions.size(), 11u);
  const auto expect = [&](std::size_t p, const Vec3& at) {
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(double{points.positions[p][k]} + points.origin[k], at[k], 1e-4) << p;
  };
  expect(0, {100, 2, 0});  // x is turned to y
  expect(1, {98, 0, 0});
  expect(10, {170, 8170, 16170});
  EXPECT_THAT(points.colours[0], ElementsAre(7, 0, 128));  // red has no range: 0 .. 255
  EXPECT_THAT(points.colours[1], ElementsAre(7, 255, 255));
}

TEST(E57, NormalsAreKeptAndColoursWhereEveryCloudHasThem) {
  const std::string single = " type=\"Float\" precision=\"single\"/>";
  const Cloud plain{"<cartesianX" + single + "<cartesianY" + single + "<cartesianZ" + single +
                        "<nor:normalX" + single + "<nor:normalY" + single + "<nor:normalZ" + single,
                    {floats<float>({1, 2}), floats<float>({3, 4}), floats<float>({5, 6}),
                     floats<float>({1, 0}), floats<float>({0, 1}), floats<float>({0, 0})},
                    2};
  const std::string wkt = "GEOGCS[\"WGS 84\"]";
  const auto scan = read(e57(
      {plain}, "<coordinateMetadata type=\"String\"><![CDATA[" + wkt + "]]></coordinateMetadata>"));
  ASSERT_TRUE(scan) << scan.error().message;
  EXPECT_THAT(scan->points.vertices.normals,
              ElementsAre(ElementsAre(1, 0, 0), ElementsAre(0, 1, 0)));
  EXPECT_THAT(scan->points.vertices.colours, IsEmpty());
  EXPECT_EQ(scan->crs, wkt);
  std::vector<std::string> warnings;
  const auto mixed = read(e57({plain, scaled_cloud()}), &warnings);
  ASSERT_TRUE(mixed) << mixed.error().message;
  EXPECT_EQ(mixed->points.vertices.positions.size(), 11u);
  EXPECT_THAT(mixed->points.vertices.colours, IsEmpty());
  EXPECT_THAT(mixed->points.vertices.normals, IsEmpty());
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("no colours")));
}

TEST(E57, WhatIsWrongIsNamed) {
  const std::string whole = e57({scaled_cloud()});
  const auto with = [&](auto change) {
    Cloud cloud = scaled_cloud();
    change(cloud);
    return refusal(e57({cloud}));
  };
  std::string damaged = whole;
  damaged[200] ^= 1;
  EXPECT_THAT(refusal(damaged), AllOf(HasSubstr("a.e57"), HasSubstr("checksum of page 1")));
  EXPECT_THAT(refusal(whole.substr(0, whole.size() - kPage)), HasSubstr("cut off"));
  EXPECT_THAT(refusal("ASTM-E57"), HasSubstr("is no E57"));
  EXPECT_THAT(refusal(e57({})), HasSubstr("data3D has no cloud"));
  EXPECT_THAT(with([](Cloud& c) { c.rows = 99; }),
              HasSubstr("cartesianX: has less than 99 values"));
  EXPECT_THAT(with([](Cloud& c) { c.rows = std::size_t{1} << 60; }), HasSubstr("recordCount"));
  EXPECT_THAT(with([](Cloud& c) { c.prototype = replaced(c.prototype, "cartesianX", "x"); }),
              AllOf(HasSubstr("data3D[0]"), HasSubstr("coordinates")));
  EXPECT_THAT(
      with([](Cloud& c) { c.prototype = replaced(c.prototype, "ScaledInteger", "String"); }),
      HasSubstr("cartesianX is of a type"));
  EXPECT_THAT(with([](Cloud& c) { c.columns.pop_back(); }), HasSubstr("a packet is damaged"));
  // Two clouds of one section: memory would be a multiple of the file.
  const std::string again =
      "<vectorChild><points fileOffset=\"48\" recordCount=\"900\"><prototype>" +
      scaled_cloud().prototype + "</prototype></points></vectorChild>";
  EXPECT_EQ(refusal(e57({scaled_cloud(900)})), "accepted");
  EXPECT_THAT(refusal(e57({scaled_cloud(900)}, "", again)), HasSubstr("overlap"));
}

// Checksums are made sound again, so that every byte reaches what reads it.
TEST(E57, NoByteLeadsOutOfTheFile) {
  const std::string whole = e57({spherical_cloud(), scaled_cloud()});
  std::string logical;
  for (std::size_t at = 0; at < whole.size(); at += kPage) logical += whole.substr(at, kPayload);
  for (std::size_t at = 0; at < logical.size(); at += 3) {
    EXPECT_NE(refusal(whole.substr(0, at)), "accepted");
    std::string changed = logical;
    changed[at] = at % 2 == 0 ? '\xFF' : '9';
    const auto scan = read(paged(changed));
    EXPECT_LE(scan ? scan->points.vertices.positions.size() : 0, 13u) << at;
  }
}

}  // namespace
}  // namespace slf::e57_test
