// SPDX-License-Identifier: Apache-2.0
// Text from files, on its way to a terminal.
#include <algorithm>
#include <cstdint>

#include "tools/text.h"

namespace slf::tools {
namespace {

/// One character of UTF-8. bytes 0: it is none.
struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 0;
};

Character character_at(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) -> std::uint32_t {
    return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0u;
  };
  const std::uint32_t first = byte(0);
  if (first < 0x80) return {first, 1};
  const std::size_t bytes = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4) return {};
  std::uint32_t code = first & (0x7Fu >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3F);
  }
  constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};  // else not the shortest form
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kLeast[bytes] || code > 0x10FFFF || surrogate) return {};
  return {code, bytes};
}

/// C0, DEL and C1; line and paragraph separators; what turns the direction of writing.
bool steers(std::uint32_t c) {
  return c < 0x20 || (c >= 0x7F && c < 0xA0) || c == 0x061C || c == 0x200E || c == 0x200F ||
         (c >= 0x2028 && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
}

constexpr std::size_t kMostPrintable = 4096;  // bytes: names of files are shorter

}  // namespace

std::string printable(const std::string& foreign) {
  std::string out;
  for (std::size_t at = 0; at < foreign.size();) {
    if (out.size() >= kMostPrintable)
      return out + "... (" + grouped(foreign.size() - at) + " more bytes)";
    const Character c = character_at(foreign, at);
    if (c.bytes == 0 || steers(c.code)) {
      out += '?';
    } else {
      out.append(foreign, at, c.bytes);
    }
    at += c.bytes > 0 ? c.bytes : 1;
  }
  return out;
}

std::string to_text(const nlohmann::ordered_json& json) {
  const std::string written =
      json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string out;
  for (std::size_t at = 0; at < written.size();) {
    const Character c = character_at(written, at);  // of a string, or a line end between elements
    if (c.bytes > 0 && c.code != '\n' && steers(c.code)) {
      out += text("\\u%04x", c.code);
    } else {
      out.append(written, at, std::max<std::size_t>(c.bytes, 1));
    }
    at += std::max<std::size_t>(c.bytes, 1);
  }
  return out + "\n";
}

}  // namespace slf::tools
