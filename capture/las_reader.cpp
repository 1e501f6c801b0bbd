// SPDX-License-Identifier: Apache-2.0
// Source: ASPRS, LAS Specification 1.4 R15, 2.4 (public header block), 2.5, 2.6; 4.1 (WKT).
#include "capture/las_reader.h"

#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>

#include "capture/exact_positions.h"
#include "capture/input_file.h"
#include "capture/little_endian.h"
#include "capture/ply_colours.h"

namespace slf {

namespace {

constexpr std::size_t kLeastHeader = 227, kHeader14 = 375;  // bytes; the latter of LAS 1.4
constexpr std::uint64_t kMostHeadBytes = std::uint64_t{1} << 26;
constexpr std::size_t kVlrHeader = 54;
constexpr std::uint16_t kWktRecord = 2112, kGeoKeysRecord = 34735;

/// Bytes of a record of each point format at the least, and where its colour is; 0: it has none.
struct LasFormat {
  std::uint8_t bytes, colour;
};
constexpr std::array<LasFormat, 11> kLasFormats{{{20, 0},
                                                 {28, 0},
                                                 {26, 20},
                                                 {34, 28},
                                                 {57, 0},
                                                 {63, 28},
                                                 {30, 0},
                                                 {36, 30},
                                                 {38, 30},
                                                 {59, 0},
                                                 {67, 30}}};

struct LasHeader {
  std::uint64_t points_at = 0, count = 0;
  std::uint32_t header_bytes = 0, num_vlrs = 0;
  LasFormat format{};
  std::size_t record_bytes = 0;
  Vec3 scale{}, offset{};
};

bool begins_as_las(std::span<const std::uint8_t> head) {
  return head.size() >= kLeastHeader && std::memcmp(head.data(), "LASF", 4) == 0;
}

/// Bits 6 and 7 of the format are LASzip's.
bool is_compressed(std::span<const std::uint8_t> head) { return (head[104] & 0xC0) != 0; }

Result<LasHeader, InputError> parse_las_header(const std::string& name,
                                               std::span<const std::uint8_t> head,
                                               std::uint64_t file_bytes) {
  const auto invalid = [&](const std::string& cause) {
    return InputError{Errc::kInvalidInput, name + ": " + cause};
  };
  if (head[24] != 1 || head[25] > 4)
    return invalid("version: LAS " + std::to_string(head[24]) + "." + std::to_string(head[25]) +
                   ", not 1.0 to 1.4");
  if (is_compressed(head)) return invalid("point data format: LAZ, which is compressed");
  LasHeader header;
  const std::size_t format = head[104];
  if (format >= kLasFormats.size())
    return invalid("point data format " + std::to_string(format) + ", not 0 to 10");
  header.format = kLasFormats[format];
  header.header_bytes = little<std::uint16_t>(head, 94);
  header.points_at = little<std::uint32_t>(head, 96);
  header.num_vlrs = little<std::uint32_t>(head, 100);
  header.record_bytes = little<std::uint16_t>(head, 105);
  header.count = little<std::uint32_t>(head, 107);
  if (header.header_bytes < kLeastHeader || header.points_at < header.header_bytes)
    return invalid("header size or offset to point data is too small");
  if (head[25] == 4 && header.header_bytes >= kHeader14 && head.size() >= kHeader14)
    if (const auto wide = little<std::uint64_t>(head, 247); wide > 0) header.count = wide;
  if (header.record_bytes < header.format.bytes)
    return invalid("point data record length is less than that of its format");
  if (header.points_at > file_bytes ||
      header.count > (file_bytes - header.points_at) / header.record_bytes)
    return invalid("number of points: " + std::to_string(header.count) + " are not in the file");
  for (std::size_t k = 0; k < 3; ++k) {
    header.scale[k] = little_double(head, 131 + 8 * k);
    header.offset[k] = little_double(head, 155 + 8 * k);
    if (!std::isfinite(header.offset[k]) || !std::isfinite(header.scale[k]) || header.scale[k] == 0)
      return invalid("scale or offset of axis " + std::to_string(k) + " is 0 or not finite");
  }
  return header;
}

/// What variable length records say of the coordinate system.
struct LasSystem {
  std::string wkt;
  bool geo_keys = false;
};

LasSystem find_system(std::span<const std::uint8_t> records, std::uint32_t count) {
  LasSystem system;
  std::size_t at = 0;
  for (std::uint32_t i = 0; i < count && records.size() - at >= kVlrHeader; ++i) {
    const std::string_view user(reinterpret_cast<const char*>(&records[at + 2]), 16);
    const auto id = little<std::uint16_t>(records, at + 18);
    const std::size_t bytes = little<std::uint16_t>(records, at + 20);
    at += kVlrHeader;
    if (bytes > records.size() - at) break;
    if (user.starts_with("LASF_Projection") && id == kWktRecord) {
      system.wkt.assign(reinterpret_cast<const char*>(records.data()) + at, bytes);
      system.wkt.resize(std::min(system.wkt.find('\0'), system.wkt.size()));
    }
    system.geo_keys =
        system.geo_keys || (user.starts_with("LASF_Projection") && id == kGeoKeysRecord);
    at += bytes;
  }
  return system;
}

/// Positions and colours, a block of records at a time.
Result<Done, InputError> read_las_points(InputFile& in, const std::string& name,
                                         const LasHeader& header, PointCloud& cloud,
                                         PlyColours& colours) {
  constexpr std::uint64_t kBlock = 1 << 14;  // records
  std::vector<Vec3> positions;
  positions.reserve(static_cast<std::size_t>(header.count));
  std::vector<std::uint8_t> block;
  for (std::uint64_t first = 0; first < header.count; first += kBlock) {
    const auto records = static_cast<std::size_t>(std::min(kBlock, header.count - first));
    block.resize(records * header.record_bytes);
    SLF_TRY(const std::size_t got, in.read(block));
    if (got < block.size()) return InputError{Errc::kInvalidInput, name + ": points are cut off"};
    for (std::size_t i = 0; i < records; ++i) {
      const auto record = std::span(block).subspan(i * header.record_bytes, header.record_bytes);
      Vec3 position{};
      for (std::size_t k = 0; k < 3; ++k)
        position[k] = little<std::int32_t>(record, 4 * k) * header.scale[k] + header.offset[k];
      positions.push_back(position);
      if (header.format.colour == 0) continue;
      std::array<double, 3> colour{};
      for (std::size_t k = 0; k < 3; ++k)
        colour[k] = little<std::uint16_t>(record, header.format.colour + 2 * k);
      if (colours.add(colour))
        return InputError{Errc::kInvalidInput, name + ": a colour is out of range"};
    }
  }
  set_positions(positions, cloud);
  return Done{};
}

Result<std::vector<std::uint8_t>, InputError> read_las_bytes(InputFile& in, std::uint64_t count) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(count));
  SLF_TRY(const std::size_t got, in.read(bytes));
  bytes.resize(got);
  return bytes;
}

/// All that stands before the points.
Result<std::vector<std::uint8_t>, InputError> read_las_head(InputFile& in,
                                                            const std::string& name) {
  SLF_TRY(auto head, read_las_bytes(in, kLeastHeader));
  const std::uint64_t points_at = begins_as_las(head) ? little<std::uint32_t>(head, 96) : 0;
  if (points_at < kLeastHeader || points_at > std::min(in.size(), kMostHeadBytes))
    return InputError{Errc::kInvalidInput,
                      name + ": offset to point data is outside the file, or above 64 MiB"};
  SLF_TRY(const auto more, read_las_bytes(in, points_at - kLeastHeader));
  head.insert(head.end(), more.begin(), more.end());
  if (head.size() < points_at) return InputError{Errc::kInvalidInput, name + ": is cut off"};
  return head;
}

}  // namespace

bool is_plain_las(const std::filesystem::path& file) {
  auto in = InputFile::open(file);
  if (!in) return false;
  const auto head = read_las_bytes(*in, std::min<std::uint64_t>(in->size(), kLeastHeader));
  return head && begins_as_las(*head) && !is_compressed(*head);
}

Result<Scan, InputError> read_las(const std::filesystem::path& file,
                                  std::vector<std::string>* warnings) {
  const std::string name = file.string();
  SLF_TRY(InputFile in, InputFile::open(file));
  SLF_TRY(const auto head, read_las_head(in, name));
  SLF_TRY(const LasHeader header, parse_las_header(name, head, in.size()));
  const LasSystem system =
      find_system(std::span(head).subspan(header.header_bytes), header.num_vlrs);
  Scan scan;
  constexpr std::array kWide{PlyType::kUint16, PlyType::kUint16, PlyType::kUint16};
  PlyColours colours(kWide);
  SLF_CHECK(read_las_points(in, name, header, scan.points.vertices, colours));
  scan.points.vertices.colours = colours.take();
  scan.crs = system.wkt;
  if (warnings != nullptr && system.wkt.empty() && system.geo_keys)
    warnings->push_back(name +
                        ": its coordinate system is written as keys of GeoTIFF, which are not "
                        "kept: --crs FILE gives it as WKT");
  if (const std::string warning = colours.warning(); warnings != nullptr && !warning.empty())
    warnings->push_back(name + ": " + warning);
  return scan;
}

}  // namespace slf
