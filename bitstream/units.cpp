#include "bitstream/units.h"

#include <algorithm>

#include "bitstream/bit_reader.h"
#include "bitstream/zlib_adapter.h"

namespace slf {
namespace {

constexpr int kMaxLengthBytes = 6;  // 42 bits

/// unit_length, seven bits a byte, least significant first. Advances `at`.
Result<std::uint64_t> read_length(std::span<const std::uint8_t> stream, std::size_t& at) {
  std::uint64_t length = 0;
  for (int i = 0; i < kMaxLengthBytes; ++i) {
    if (at >= stream.size()) return Error{Errc::kTruncated, "unit_length", at * 8};
    const std::uint8_t byte = stream[at++];
    length |= std::uint64_t{byte & 0x7Fu} << (7 * i);
    if (byte & 0x80) continue;
    if (byte == 0 && i > 0) break;  // not the shortest form
    return length;
  }
  return Error{Errc::kOutOfRange, "unit_length", at * 8};
}

Result<Unit> read_unit(std::span<const std::uint8_t> stream, std::size_t offset) {
  std::size_t at = offset;
  const auto type = static_cast<UnitType>(stream[at++]);
  SLF_TRY(const std::uint64_t length, read_length(stream, at));
  if (stream.size() - at < 4 || length > stream.size() - at - 4)
    return Error{Errc::kTruncated, "unit_payload", stream.size() * 8};
  const auto size = static_cast<std::size_t>(length);
  const Unit unit{type, stream.subspan(at, size), offset, at + size + 4 - offset};
  std::uint32_t expected = 0;
  for (std::size_t i = 0; i < 4; ++i) expected = expected << 8 | stream[at + size + i];
  if (crc32(stream.subspan(offset, at + size - offset)) != expected)
    return Error{Errc::kChecksum, "unit_crc", (at + size) * 8};
  return unit;
}

/// Spec 7.10  end_unit( ): no unit was lost.
Result<Done> check_end(const Unit& unit, std::size_t units_before) {
  BitReader in(unit.payload);
  const std::uint64_t count = in.ue("end_num_units");
  in.trailing_bits("end_trailing_bits");
  if (!in.ok()) return in.error();
  if (count != units_before) return Error{Errc::kOutOfRange, "end_num_units", unit.offset * 8};
  return Done{};
}

}  // namespace

const char* unit_name(UnitType type) {
  switch (type) {
    case UnitType::kSequence:
      return "sequence";
    case UnitType::kSlices:
      return "slices";
    case UnitType::kGeometry:
      return "geometry";
    case UnitType::kNormals:
      return "normals";
    case UnitType::kCoefficients:
      return "coefficients";
    case UnitType::kIndex:
      return "index";
    case UnitType::kMetadata:
      return "metadata";
    case UnitType::kDigest:
      return "digest";
    case UnitType::kTransform:
      return "transform";
    case UnitType::kEnd:
      return "end";
  }
  return "unknown";
}

Result<Units> split_units(std::span<const std::uint8_t> stream, std::uint64_t max_bytes) {
  if (stream.size() < kSignature.size() ||
      !std::equal(kSignature.begin(), kSignature.end(), stream.begin())) {
    const bool prefix = std::equal(
        stream.begin(),
        stream.begin() + static_cast<std::ptrdiff_t>(std::min(stream.size(), kSignature.size())),
        kSignature.begin());
    return Error{prefix && !stream.empty() ? Errc::kTruncated : Errc::kNotSlf, "signature", 0};
  }
  Units result;
  std::size_t at = kSignature.size();
  while (at < stream.size()) {
    if (result.complete) return Error{Errc::kOutOfRange, "end_of_stream", at * 8};
    auto unit = read_unit(stream, at);
    const bool cut = max_bytes != 0 && max_bytes < stream.size() &&
                     (unit ? at + unit->bytes > max_bytes : unit.error().code == Errc::kTruncated);
    if (cut) break;
    if (!unit) return unit.error();
    if (unit->type == UnitType::kEnd) SLF_CHECK(check_end(*unit, result.units.size()));
    result.units.push_back(*unit);
    result.complete = unit->type == UnitType::kEnd;
    at += static_cast<std::size_t>(unit->bytes);
  }
  return result;
}

void append_unit(std::vector<std::uint8_t>& stream, UnitType type,
                 std::span<const std::uint8_t> payload) {
  const std::size_t start = stream.size();
  stream.push_back(static_cast<std::uint8_t>(type));
  std::uint64_t length = payload.size();
  for (; length >= 0x80; length >>= 7) stream.push_back(static_cast<std::uint8_t>(length | 0x80));
  stream.push_back(static_cast<std::uint8_t>(length));
  stream.insert(stream.end(), payload.begin(), payload.end());
  const std::uint32_t crc = crc32(std::span(stream).subspan(start));
  for (int shift = 24; shift >= 0; shift -= 8)
    stream.push_back(static_cast<std::uint8_t>(crc >> shift));
}

std::uint64_t unit_bytes(std::uint64_t payload_bytes) {
  std::uint64_t bytes = 1 + 1 + payload_bytes + 4;
  for (std::uint64_t length = payload_bytes; length >= 0x80; length >>= 7) ++bytes;
  return bytes;
}

}  // namespace slf
