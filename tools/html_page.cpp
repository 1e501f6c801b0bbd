// SPDX-License-Identifier: Apache-2.0
#include "tools/html_page.h"

#include <map>

#include "tools/page_template.h"

namespace slf::tools {
namespace {

constexpr std::size_t kMostTitleBytes = 256;  // of a title from the file

/// Whole characters of UTF-8.
std::string shortened(std::string title) {
  if (title.size() <= kMostTitleBytes) return title;
  std::size_t end = kMostTitleBytes;
  while (end > 0 && (title[end] & 0xC0) == 0x80) --end;
  return title.substr(0, end) + "\u2026";
}

/// Nothing in it ends the script element that it stands in.
std::string script_json(const nlohmann::ordered_json& json) {
  std::string out;
  for (const char c : json.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace))
    out += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return out;
}

/// The source element for night in the template's picture element; none without such a poster.
std::string night_source(const std::string& poster) {
  if (poster.empty()) return "";
  return "<source media=\"(prefers-color-scheme: dark)\" srcset=\"" + poster + "\">";
}

}  // namespace

std::string page_title(const Metadata& metadata) {
  for (const char* wanted : {"title", "source"})
    for (const auto& [key, value] : metadata)
      if (key == wanted && !value.empty()) return shortened(value);
  return "";
}

nlohmann::ordered_json view_json(const Camera& camera) {
  auto rotation = nlohmann::ordered_json::array();
  for (const auto& row : camera.rotation)
    for (const double value : row) rotation.push_back(value);
  return {{"width", camera.width}, {"height", camera.height}, {"fx", camera.fx},
          {"fy", camera.fy},       {"cx", camera.cx},         {"cy", camera.cy},
          {"rotation", rotation},  {"eye", camera.centre()}};
}

std::string html_page(std::string_view page, const std::string& title, const Posters& posters,
                      const nlohmann::ordered_json& options, std::span<const std::uint8_t> stream) {
  const std::map<std::string, std::string> values = {
      {"title", escaped_html(title)},
      {"poster", posters.day.empty() ? "data:," : posters.day},
      {"night", night_source(posters.night)},
      {"options", script_json(options)}};
  // The file goes straight into the page: as a value it would be in memory once more.
  constexpr std::string_view kFile = "{{slf:file}}";
  const std::size_t place = page.find(kFile);
  std::string out = filled_template(page.substr(0, place), values);
  if (place == std::string_view::npos) return out;
  const std::string rest = filled_template(page.substr(place + kFile.size()), values);
  out.reserve(out.size() + base64_size(stream.size()) + rest.size());
  append_base64(out, stream.data(), stream.size());
  return out.append(rest);
}

}  // namespace slf::tools
