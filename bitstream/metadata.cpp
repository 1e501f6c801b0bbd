// SPDX-License-Identifier: Apache-2.0
#include "bitstream/metadata.h"

#include <algorithm>
#include <string>

#include "base/error_place.h"
#include "bitstream/bit_reader.h"
#include "bitstream/inflate.h"

namespace slf {
namespace {

constexpr std::uint64_t kMaxBytes = 1u << 20;

/// Key or value: up to the next zero byte.
std::string take_string(std::span<const std::uint8_t>& text) {
  std::size_t length = 0;
  while (length < text.size() && text[length] != 0) ++length;
  std::string s(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(length));
  text = text.subspan(std::min(length + 1, text.size()));
  return s;
}

/// Bytes of a character that begins with this one, 0 where none does, and the least of so many.
struct Utf8Length {
  std::size_t bytes = 0;
  std::uint32_t least = 0;
};

Utf8Length utf8_length(unsigned char first) {
  if (first < 0x80) return {1, 0};
  if (first >= 0xC0 && first < 0xE0) return {2, 0x80};
  if (first >= 0xE0 && first < 0xF0) return {3, 0x800};
  if (first >= 0xF0 && first < 0xF8) return {4, 0x10000};
  return {};
}

}  // namespace

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const auto first = static_cast<unsigned char>(text[0]);
    const auto [bytes, least] = utf8_length(first);
    if (bytes == 0 || bytes > text.size()) return false;
    std::uint32_t character = bytes == 1 ? first : first & (0x7Fu >> bytes);
    for (const char next : text.substr(1, bytes - 1)) {
      if ((next & 0xC0) != 0x80) return false;
      character = character << 6 | (static_cast<unsigned char>(next) & 0x3Fu);
    }
    const bool surrogate = character >= 0xD800 && character < 0xE000;
    if (character < least || character > 0x10FFFF || surrogate) return false;
    text.remove_prefix(bytes);
  }
  return true;
}

bool is_metadata(const Metadata& metadata) {
  std::size_t bytes = 0;
  for (const auto& [key, value] : metadata) {
    if (key.empty() || (key + value).find('\0') != std::string::npos) return false;
    if (!is_utf8(key) || !is_utf8(value)) return false;
    bytes += key.size() + value.size() + 2;
  }
  return bytes <= kMaxBytes;
}

Result<Metadata> parse_metadata(std::span<const std::uint8_t> payload) {
  BitReader in(payload);
  const std::uint64_t size = in.ue("metadata_bytes");
  const auto deflated = in.align_and_rest("metadata_bytes");
  if (!in.ok()) return in.error();
  if (size > kMaxBytes) return Error{Errc::kOutOfRange, "metadata_bytes"};
  const std::uint64_t begin = 8 * (payload.size() - deflated.size());
  const Error wrong_text{Errc::kOutOfRange, "metadata_text", begin};
  SLF_TRY(const auto text, counted_from(begin, inflate(deflated, static_cast<std::size_t>(size),
                                                       "metadata_deflated")));
  if (size > 0 && text.back() != 0) return wrong_text;
  Metadata metadata;
  for (std::span<const std::uint8_t> rest = text; !rest.empty();) {
    std::string key = take_string(rest);
    // A key without a name, or without a value.
    if (key.empty() || rest.empty()) return wrong_text;
    metadata.emplace_back(std::move(key), take_string(rest));
    if (!is_utf8(metadata.back().first) || !is_utf8(metadata.back().second)) return wrong_text;
  }
  return metadata;
}

}  // namespace slf
