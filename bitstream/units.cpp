// SPDX-License-Identifier: Apache-2.0
#include "bitstream/units.h"

#include <algorithm>

#include "bitstream/bit_reader.h"
#include "bitstream/crc32.h"
#include "bitstream/sequence_parameter_set.h"

namespace slf {
namespace {

constexpr int kMaxLengthBytes = 6;  // 42 bits
constexpr std::size_t kCrcBytes = 4, kVersionBytes = 2;

/// unit_length, seven bits a byte, least significant first. Advances `at`.
Result<std::uint64_t> read_length(std::span<const std::uint8_t> stream, std::size_t& at) {
  std::uint64_t length = 0;
  for (int i = 0; i < kMaxLengthBytes; ++i) {
    if (at >= stream.size()) return Error{Errc::kTruncated, "unit_length"};
    const std::uint8_t byte = stream[at++];
    length |= std::uint64_t{byte & 0x7Fu} << (7 * i);
    if (byte & 0x80) continue;
    if (byte == 0 && i > 0) break;  // not the shortest form
    return length;
  }
  return Error{Errc::kOutOfRange, "unit_length"};
}

/// Spec 7.1.2: two bytes, before anything that another major version may have otherwise.
Result<Done> check_version(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kVersionBytes) return Error{Errc::kTruncated, "sps_version_major"};
  if (bytes[0] != kVersionMajor) {
    Error other{Errc::kUnsupported, "sps_version_major"};
    other.versions = {bytes[0], bytes[1], kVersionMajor};
    return other;
  }
  return Done{};
}

/// "type 0" to "type 255".
using NumberedName = std::array<char, 9>;
constexpr std::array<NumberedName, 256> numbered_names() {
  std::array<NumberedName, 256> names{};
  for (unsigned type = 0; type < 256; ++type) {
    NumberedName name = {'t', 'y', 'p', 'e', ' '};
    std::size_t at = 5;
    for (const unsigned unit : {100u, 10u, 1u})
      if (type >= unit || unit == 1) name[at++] = static_cast<char>('0' + type / unit % 10);
    names[type] = name;
  }
  return names;
}
constexpr std::array<NumberedName, 256> kNumberedNames = numbered_names();

/// The unit that begins at `offset`, without its payload: the stream may end before that does.
Result<Unit> read_head(std::span<const std::uint8_t> stream, std::size_t offset) {
  if (offset >= stream.size()) return Error{Errc::kTruncated, "unit_type", 8 * offset};
  std::size_t at = offset;
  Unit unit{static_cast<UnitType>(stream[at++]), {}, offset, 0, offset + 1};
  if (unit.type == UnitType::kSequence) {
    SLF_CHECK(in_unit(unit, check_version(stream.subspan(at))));
    at += kVersionBytes;
  }
  SLF_TRY(const std::uint64_t length, in_unit(unit, read_length(stream, at)));
  unit.payload_offset = at;
  unit.bytes = at - offset + length + kCrcBytes;
  return unit;
}

/// The same with its payload; its checksum is in the stream, and not looked at.
Result<Unit> find_unit(std::span<const std::uint8_t> stream, std::size_t offset) {
  SLF_TRY(Unit unit, read_head(stream, offset));
  if (unit.bytes > stream.size() - offset)
    return in_unit(unit, Error{Errc::kTruncated, "unit_payload"});
  const auto bytes = stream.subspan(offset, static_cast<std::size_t>(unit.bytes) - kCrcBytes);
  unit.payload = bytes.subspan(static_cast<std::size_t>(unit.payload_offset) - offset);
  return unit;
}

}  // namespace

Result<Done> check_end(std::span<const std::uint8_t> payload, std::size_t units_before) {
  BitReader in(payload);
  const std::uint64_t count = in.ue("end_num_units");
  in.trailing_bits("end_trailing_bits");
  if (!in.ok()) return in.error();
  if (count != units_before) return Error{Errc::kOutOfRange, "end_num_units"};
  return Done{};
}

namespace {

/// nullptr where 7.1 has no name.
const char* name_of(UnitType type) {
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
    case UnitType::kFiller:
      return "filler";
    case UnitType::kRefinement:
      return "refinement";
    case UnitType::kFrame:
      return "frame";
    case UnitType::kEnd:
      return "end";
  }
  return nullptr;
}

}  // namespace

const char* unit_name(UnitType type) {
  const char* name = name_of(type);
  return name != nullptr ? name : kNumberedNames[static_cast<std::uint8_t>(type)].data();
}

Result<Done> check_understood(UnitType type, std::uint64_t offset) {
  if (name_of(type) != nullptr || (static_cast<unsigned>(type) & kSkipBit) != 0) return Done{};
  return of_unit(type, offset, Errc::kUnsupported, "unit_type");
}

bool is_of_application(const Unit& unit, const ApplicationId& id) {
  return unit.type == kApplicationUnit && unit.payload.size() >= id.size() &&
         std::equal(id.begin(), id.end(), unit.payload.begin());
}

std::span<const std::uint8_t> application_payload(const Unit& unit) {
  return unit.payload.subspan(sizeof(ApplicationId));
}

std::vector<std::uint8_t> with_identifier(const ApplicationId& id,
                                          std::span<const std::uint8_t> payload) {
  std::vector<std::uint8_t> all(id.begin(), id.end());
  all.insert(all.end(), payload.begin(), payload.end());
  return all;
}

const Unit* Units::first(UnitType type) const {
  const auto found = std::find_if(units.begin(), units.end(),
                                  [type](const Unit& unit) { return unit.type == type; });
  return found == units.end() ? nullptr : &*found;
}

Error of_unit(UnitType type, std::uint64_t offset, Errc code, const char* element) {
  return {code, element, 8 * offset, unit_name(type)};
}

Error of_sequence(Errc code, const char* element) {
  return of_unit(UnitType::kSequence, kSignature.size(), code, element);
}

Result<std::uint64_t> end_of_unit(std::span<const std::uint8_t> stream, std::uint64_t offset) {
  SLF_TRY(const Unit unit, read_head(stream, static_cast<std::size_t>(offset)));
  return offset + unit.bytes;
}

Result<Unit> read_unit(std::span<const std::uint8_t> stream, std::size_t offset) {
  SLF_TRY(const Unit unit, find_unit(stream, offset));
  const auto bytes = stream.subspan(offset, static_cast<std::size_t>(unit.bytes));
  const auto checked = bytes.first(bytes.size() - kCrcBytes);
  std::uint32_t expected = 0;
  for (const std::uint8_t byte : bytes.last(kCrcBytes)) expected = expected << 8 | byte;
  if (crc32(checked) != expected)
    return Error{Errc::kChecksum, "unit_crc", 8 * (offset + checked.size()), unit_name(unit.type)};
  return unit;
}

std::uint64_t listed_units(const Unit& unit) {
  if (unit.type != UnitType::kIndex) return 0;
  BitReader in(unit.payload);
  const std::uint64_t count = in.ue("index_num_units");
  return in.ok() ? std::min(count, in.bits_left() / kLeastIndexEntryBits) : 0;
}

Result<Unit> UnitWalk::next(std::span<const std::uint8_t> stream) const {
  if (complete_) return Error{Errc::kOutOfRange, "end_of_stream", 8 * at_};
  return read_unit(stream, static_cast<std::size_t>(at_));
}

Result<Done> UnitWalk::take(const Unit& unit) {
  const std::uint64_t kept = 1 + listed_units(unit);
  if (kept > left_) return Error{Errc::kLimitExceeded, "max_memory"};
  left_ -= kept;
  complete_ = unit.type == UnitType::kEnd;
  if (complete_) SLF_CHECK(in_unit(unit, check_end(unit.payload, units_)));
  ++units_;
  at_ += unit.bytes;
  return Done{};
}

Result<Units> split_units(std::span<const std::uint8_t> stream, std::uint64_t max_bytes,
                          std::uint64_t max_memory) {
  if (stream.size() < kSignature.size() ||
      !std::equal(kSignature.begin(), kSignature.end(), stream.begin())) {
    const bool prefix = std::equal(
        stream.begin(),
        stream.begin() + static_cast<std::ptrdiff_t>(std::min(stream.size(), kSignature.size())),
        kSignature.begin());
    return Error{prefix && !stream.empty() ? Errc::kTruncated : Errc::kNotSlf, "signature", 0};
  }
  Units result;
  UnitWalk walk(max_memory);
  while (walk.at() < stream.size()) {
    const auto unit = walk.next(stream);
    const bool cut =
        max_bytes != 0 && max_bytes < stream.size() &&
        (unit ? walk.at() + unit->bytes > max_bytes : unit.error().code == Errc::kTruncated);
    if (cut) break;
    if (!unit) return unit.error();
    if (result.units.empty() && unit->type == UnitType::kSequence) {
      result.version_major = stream[kSignature.size() + 1];
      result.version_minor = stream[kSignature.size() + 2];
    }
    SLF_CHECK(walk.take(*unit));
    result.units.push_back(*unit);
  }
  result.complete = walk.complete();
  return result;
}

void append_unit(std::vector<std::uint8_t>& stream, UnitType type,
                 std::span<const std::uint8_t> payload, int version_minor) {
  const std::size_t start = stream.size();
  stream.push_back(static_cast<std::uint8_t>(type));
  if (type == UnitType::kSequence) {
    stream.push_back(kVersionMajor);
    stream.push_back(static_cast<std::uint8_t>(version_minor));
  }
  std::uint64_t length = payload.size();
  for (; length >= 0x80; length >>= 7) stream.push_back(static_cast<std::uint8_t>(length | 0x80));
  stream.push_back(static_cast<std::uint8_t>(length));
  stream.insert(stream.end(), payload.begin(), payload.end());
  const std::uint32_t crc = crc32(std::span(stream).subspan(start));
  for (int shift = 24; shift >= 0; shift -= 8)
    stream.push_back(static_cast<std::uint8_t>(crc >> shift));
}

std::uint64_t unit_bytes(UnitType type, std::uint64_t payload_bytes) {
  std::uint64_t bytes = 1 + 1 + payload_bytes + kCrcBytes;
  if (type == UnitType::kSequence) bytes += kVersionBytes;
  for (std::uint64_t length = payload_bytes; length >= 0x80; length >>= 7) ++bytes;
  return bytes;
}

}  // namespace slf
