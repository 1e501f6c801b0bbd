// SPDX-License-Identifier: Apache-2.0
#include "capture/e57_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string_view>
#include <utility>

#include "capture/little_endian.h"
#include "slf/capture.h"

namespace slf {

namespace {

constexpr std::string_view kSignature = "ASTM-E57";
constexpr std::size_t kHeader = 48, kChecksum = 4, kSectionHeader = 32, kPacketHeader = 4;
constexpr std::uint64_t kLeastPage = 64, kMostPage = std::uint64_t{1} << 20;

/// CRC-32C, reflected; E57 writes it big endian.
std::uint32_t crc_of(std::span<const std::uint8_t> bytes) {
  static constexpr auto kTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t crc = i;
      for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0x82F63B78u : 0);
      table[i] = crc;
    }
    return table;
  }();
  std::uint32_t crc = ~0u;
  for (const std::uint8_t byte : bytes) crc = crc >> 8 ^ kTable[(crc ^ byte) & 0xFF];
  return ~crc;
}

std::uint32_t checksum_in(std::span<const std::uint8_t> four) {
  return std::uint32_t{four[0]} << 24 | std::uint32_t{four[1]} << 16 | std::uint32_t{four[2]} << 8 |
         four[3];
}

enum PacketType : std::uint8_t { kIndex = 0, kData = 1, kEmpty = 2 };

/// Adds what a packet of data has of each column; false where its lengths do not fit in it.
bool add_packet(std::span<const std::uint8_t> bytes,
                std::vector<std::vector<std::uint8_t>>& packed) {
  if (bytes.size() < kPacketHeader + 2) return false;
  const std::size_t streams = little<std::uint16_t>(bytes, kPacketHeader);
  std::size_t at = kPacketHeader + 2 + 2 * streams;
  if (streams != packed.size() || at > bytes.size()) return false;
  for (std::size_t s = 0; s < streams; ++s) {
    const std::size_t length = little<std::uint16_t>(bytes, kPacketHeader + 2 + 2 * s);
    if (length > bytes.size() - at) return false;
    const auto piece = bytes.subspan(at, length);
    packed[s].insert(packed[s].end(), piece.begin(), piece.end());
    at += length;
  }
  return true;
}

}  // namespace

int E57Column::bits() const {
  if (kind != Kind::kInteger) return kind == Kind::kSingle ? 32 : 64;
  return static_cast<int>(
      std::bit_width(static_cast<std::uint64_t>(maximum) - static_cast<std::uint64_t>(minimum)));
}

double E57Columns::value(std::size_t column, std::size_t row) const {
  const E57Column& c = columns_[column];
  const auto& bytes = packed_[column];
  if (c.kind == E57Column::Kind::kSingle) return double{little_float(bytes, 4 * row)};
  if (c.kind == E57Column::Kind::kDouble) return little_double(bytes, 8 * row);
  const auto bits = static_cast<std::size_t>(c.bits());
  std::uint64_t raw = 0;
  for (std::size_t got = 0, at = row * bits; got < bits;) {
    const std::size_t shift = (at + got) % 8, taken = std::min(8 - shift, bits - got);
    const std::uint64_t piece = bytes[(at + got) / 8] >> shift & ((1u << taken) - 1);
    raw |= piece << got;
    got += taken;
  }
  const auto whole = static_cast<std::int64_t>(static_cast<std::uint64_t>(c.minimum) + raw);
  return static_cast<double>(whole) * c.scale + c.offset;
}

Result<E57File, InputError> E57File::open(const std::filesystem::path& file) {
  E57File e57;
  e57.name_ = file.string();
  SLF_TRY(e57.bytes_, read_file(file));
  auto& bytes = e57.bytes_;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (bytes.size() < kHeader || !text.starts_with(kSignature)) return e57.invalid("is no E57");
  if (const auto major = little<std::uint32_t>(bytes, 8); major != 1)
    return e57.invalid("E57 of version " + std::to_string(major) + ", not 1");
  e57.xml_offset_ = little<std::uint64_t>(bytes, 24);
  e57.xml_bytes_ = little<std::uint64_t>(bytes, 32);
  const auto page = e57.page_ = little<std::uint64_t>(bytes, 40);
  if (page < kLeastPage || page > kMostPage) return e57.invalid("page size is out of range");
  if (little<std::uint64_t>(bytes, 16) != bytes.size() || bytes.size() % page != 0)
    return e57.invalid("is cut off, or longer than its header says");
  const std::size_t payload = page - kChecksum;
  for (std::size_t p = 0; p < bytes.size() / page; ++p) {
    const auto whole = std::span(bytes).subspan(p * page, page);
    if (checksum_in(whole.last(kChecksum)) != crc_of(whole.first(payload)))
      return e57.invalid("checksum of page " + std::to_string(p) + ": the file is damaged");
    std::copy_n(whole.begin(), payload, bytes.begin() + static_cast<std::ptrdiff_t>(p * payload));
  }
  bytes.resize(bytes.size() / page * payload);
  e57.left_ = bytes.size();
  SLF_TRY(const auto xml, e57.from(e57.xml_offset_));
  if (e57.xml_bytes_ > xml.size()) return e57.invalid("its XML is outside the file");
  return e57;
}

std::span<const std::uint8_t> E57File::xml() const {
  return from(xml_offset_)->first(static_cast<std::size_t>(xml_bytes_));
}

Result<E57Columns, InputError> E57File::read(std::uint64_t offset, std::uint64_t rows,
                                             std::vector<E57Column> columns) {
  SLF_TRY(const auto section, from(offset));
  if (section.size() < kSectionHeader || section[0] != 1)
    return invalid("no compressed vector where one is said to be");
  const auto length = little<std::uint64_t>(section, 8);
  SLF_TRY(auto data, from(little<std::uint64_t>(section, 16)));
  if (length < kSectionHeader || length > section.size() || data.size() > section.size())
    return invalid("a compressed vector is longer than the file");
  if (length > left_) return invalid("compressed vectors overlap");
  left_ -= length;
  const std::size_t before = section.size() - data.size();
  data = data.first(static_cast<std::size_t>(std::max<std::uint64_t>(length, before)) - before);
  E57Columns out;
  out.packed_.resize(columns.size());
  while (data.size() >= kPacketHeader) {
    const std::size_t size = std::size_t{little<std::uint16_t>(data, 2)} + 1;
    if (size > data.size()) return invalid("a packet is longer than its section");
    if (data[0] > kEmpty || (data[0] == kData && !add_packet(data.first(size), out.packed_)))
      return invalid("a packet is damaged");
    data = data.subspan(size);
  }
  std::uint64_t bytes = 0;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const auto bits = static_cast<std::uint64_t>(columns[c].bits());
    bytes += out.packed_[c].size();
    if (bits > 0 && rows > out.packed_[c].size() * std::uint64_t{8} / bits)
      return invalid(columns[c].name + ": has less than " + std::to_string(rows) + " values");
  }
  if (rows > bytes) return invalid("a cloud has less than a byte a point");
  out.columns_ = std::move(columns);
  out.rows_ = static_cast<std::size_t>(rows);
  return out;
}

Result<std::span<const std::uint8_t>, InputError> E57File::from(std::uint64_t offset) const {
  const std::uint64_t pages = offset / page_, within = offset % page_;
  if (within >= page_ - kChecksum || pages > bytes_.size() ||
      offset - kChecksum * pages > bytes_.size())
    return invalid("an offset is outside the file");
  return std::span(bytes_).subspan(static_cast<std::size_t>(offset - kChecksum * pages));
}

InputError E57File::invalid(const std::string& cause) const {
  return {Errc::kInvalidInput, name_ + ": " + cause};
}

}  // namespace slf
