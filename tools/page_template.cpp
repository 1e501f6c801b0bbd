// SPDX-License-Identifier: Apache-2.0
#include "tools/page_template.h"

#include <cstdint>

#ifdef SLF_PAGE_FILE
// The file's bytes as they are: a string literal of this length takes compilers minutes.
__asm__(
    ".section .rodata\n"
    "slf_page_begin:\n"
    ".incbin \"" SLF_PAGE_FILE
    "\"\n"
    "slf_page_end:\n"
    ".byte 0\n"
    ".text\n");
extern "C" const char slf_page_begin[];
extern "C" const char slf_page_end[];
#endif

namespace slf::tools {

std::string_view page_template() {
#ifdef SLF_PAGE_FILE
  return {slf_page_begin, static_cast<std::size_t>(slf_page_end - slf_page_begin)};
#else
  return {};
#endif
}

std::string filled_template(std::string_view page,
                            const std::map<std::string, std::string>& values) {
  constexpr std::string_view kOpen = "{{slf:", kClose = "}}";
  std::string out;
  std::size_t size = page.size();
  for (const auto& [name, value] : values) size += value.size();  // each stands there once
  out.reserve(size);
  std::size_t at = 0;
  for (std::size_t open; (open = page.find(kOpen, at)) != std::string_view::npos;) {
    const std::size_t begin = open + kOpen.size(), end = page.find(kClose, begin);
    if (end == std::string_view::npos) break;
    const auto found = values.find(std::string(page.substr(begin, end - begin)));
    out.append(page.substr(at, open - at));
    if (found != values.end()) out.append(found->second);
    at = end + kClose.size();
  }
  out.append(page.substr(at));
  return out;
}

std::string escaped_html(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (c == '\'')
      out += "&#39;";
    else
      out += c;
  }
  return out;
}

std::string base64(const void* data, std::size_t size) {
  std::string out;
  out.reserve(base64_size(size));
  append_base64(out, data, size);
  return out;
}

void append_base64(std::string& out, const void* data, std::size_t size) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  for (std::size_t i = 0; i < size; i += 3) {
    const std::size_t count = size - i < 3 ? size - i : 3;
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) three = three << 8 | (k < count ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += k <= count ? kDigits[three >> (18 - 6 * k) & 63] : '=';
  }
}

}  // namespace slf::tools
