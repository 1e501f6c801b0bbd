// SPDX-License-Identifier: Apache-2.0
#include "tools/rd/igc/igc_file.h"

#include <algorithm>

#include "bitstream/crc32.h"

namespace slf {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kSectionLengthBytes = 8, kCrcBytes = 4;
static_assert(kSectionLengthBytes + kCrcBytes == kIgcSectionBytes);

void append_number(std::vector<std::uint8_t>& out, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) out.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}

std::uint64_t number(Bytes bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) value |= std::uint64_t{bytes[i]} << 8 * i;
  return value;
}

Result<Bytes> take_section(Bytes stream, std::size_t& at, const char* element) {
  const Error truncated{Errc::kTruncated, element, at * 8};
  Bytes rest = stream.subspan(at);
  if (rest.size() < kIgcSectionBytes) return truncated;
  const std::uint64_t length = number(rest.first(kSectionLengthBytes));
  if (length > rest.size() - kIgcSectionBytes) return truncated;
  const auto size = static_cast<std::size_t>(length);
  const Bytes payload = rest.subspan(kSectionLengthBytes, size);
  if (crc32(payload) != number(rest.subspan(kSectionLengthBytes + size, kCrcBytes)))
    return Error{Errc::kChecksum, element, at * 8};
  at += kIgcSectionBytes + size;
  return payload;
}

}  // namespace

std::vector<std::uint8_t> write_igc_file(const IgcSections& sections) {
  std::vector<std::uint8_t> out(kIgcSignature.begin(), kIgcSignature.end());
  for (const Bytes payload : {sections.parameters, sections.geometry, sections.images}) {
    append_number(out, payload.size(), kSectionLengthBytes);
    out.insert(out.end(), payload.begin(), payload.end());
    append_number(out, crc32(payload), kCrcBytes);
  }
  return out;
}

Result<IgcSections> read_igc_file(Bytes stream) {
  if (stream.size() < kIgcSignature.size() ||
      !std::equal(kIgcSignature.begin(), kIgcSignature.end(), stream.begin()))
    return Error{Errc::kNotSlf, "igc_signature", 0};
  std::size_t at = kIgcSignature.size();
  IgcSections sections;
  SLF_TRY(sections.parameters, take_section(stream, at, "igc_parameters"));
  SLF_TRY(sections.geometry, take_section(stream, at, "igc_geometry"));
  SLF_TRY(sections.images, take_section(stream, at, "igc_images"));
  if (at != stream.size()) return Error{Errc::kOutOfRange, "igc_end", at * 8};
  return sections;
}

}  // namespace slf
