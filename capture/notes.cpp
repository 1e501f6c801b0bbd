// SPDX-License-Identifier: Apache-2.0
// The rules of docs/notes.md, in the order of web/viewer/notes.js.
#include "slf/notes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "base/shortest.h"
#include "capture/json.h"

namespace slf {
namespace {

constexpr std::size_t kMostAnnotations = 200, kMostTracks = 20, kMostStops = 200;
constexpr std::size_t kMostTitle = 200, kMostText = 4000;
constexpr double kMostSeconds = 600;

struct ViewNumber {
  const char* name;
  double low, high;
};
constexpr std::array<ViewNumber, 4> kViewNumbers{
    {{"azimuth", -360, 360}, {"elevation", -90, 90}, {"fov", 1, 170}, {"zoom", 0.05, 50}}};

/// As JavaScript counts characters: two for what is beyond 16 bits.
std::size_t utf16_length(std::string_view text) {
  std::size_t length = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >> 6 != 2) length += byte >= 0xf0 ? 2 : 1;
  }
  return length;
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// The beginning of a text's first tag, "<b" or "</b"; empty: there is none.
std::string_view first_tag(std::string_view text) {
  for (std::size_t i = text.find('<'); i != text.npos; i = text.find('<', i + 1)) {
    std::size_t end = i + 1;
    if (end < text.size() && std::string_view("/!?").find(text[end]) != text.npos) ++end;
    const std::size_t name = end;
    while (end < text.size() && is_letter(text[end])) ++end;
    if (end > name || text.substr(i).starts_with("<!--")) return text.substr(i, end - i);
  }
  return {};
}

Result<Done, InputError> check_text(const JsonView& view, std::size_t most) {
  SLF_TRY(const std::string text, view.string());
  if (utf16_length(text) > most)
    return view.error("longer than " + std::to_string(most) + " characters");
  if (const auto tag = first_tag(text); !tag.empty())
    return view.error("has markup, '" + std::string(tag) + "', and notes are plain text");
  return Done{};
}

Result<Done, InputError> check_number(const JsonView& view, double low, double high) {
  SLF_TRY(const double value, view.number());
  if (value >= low && value <= high) return Done{};
  return view.error(shortest(value) + " is not in the range " + shortest(low) + " to " +
                    shortest(high));
}

Result<Done, InputError> check_triple(const JsonView& view) {
  SLF_TRY(const JsonItems items, view.items(3));
  for (const JsonView item : items) SLF_CHECK(item.number());
  return Done{};
}

Result<Done, InputError> check_view(const JsonView& view) {
  SLF_CHECK(view.expect_object());
  for (const auto& [name, low, high] : kViewNumbers)
    if (const auto given = view.find(name)) SLF_CHECK(check_number(*given, low, high));
  if (const auto target = view.find("target")) SLF_CHECK(check_triple(*target));
  return Done{};
}

Result<Done, InputError> check_annotation(const JsonView& annotation) {
  SLF_TRY(const JsonView at, annotation.at("at"));
  SLF_CHECK(check_triple(at));
  SLF_TRY(const JsonView title, annotation.at("title"));
  SLF_CHECK(check_text(title, kMostTitle));
  if (const auto text = annotation.find("text")) SLF_CHECK(check_text(*text, kMostText));
  if (const auto view = annotation.find("view")) SLF_CHECK(check_view(*view));
  return Done{};
}

Result<Done, InputError> check_stop(const JsonView& stop, std::size_t annotations) {
  SLF_TRY(const JsonView view, stop.at("view"));
  SLF_CHECK(check_view(view));
  for (const char* name : {"seconds", "pause"})
    if (const auto given = stop.find(name)) SLF_CHECK(check_number(*given, 0, kMostSeconds));
  if (const auto shown = stop.find("annotation")) {
    SLF_TRY(const double number, shown->number());
    if (!(number >= 0 && number < static_cast<double>(annotations)) || number != std::floor(number))
      return shown->error("is no number of an annotation, from 0 on");
  }
  return Done{};
}

/// A list of the root or of a track, which may be missing where `required` is not set.
Result<JsonItems, InputError> entries_of(const JsonView& from, const char* name, std::size_t most,
                                         bool required = false) {
  const auto found = from.find(name);
  if (!found && !required) return JsonItems{};
  SLF_TRY(const JsonView list, from.at(name));
  SLF_TRY(const JsonItems items, list.items());
  if (items.size() > most) return list.error("more than " + std::to_string(most) + " entries");
  if (required && items.empty()) return list.error("empty");
  return items;
}

Result<Done, InputError> check_track(const JsonView& track, std::size_t annotations) {
  SLF_TRY(const JsonView name, track.at("name"));
  SLF_CHECK(check_text(name, kMostTitle));
  if (const auto loop = track.find("loop")) SLF_CHECK(loop->boolean());
  SLF_TRY(const JsonItems stops, entries_of(track, "stops", kMostStops, true));
  for (const JsonView stop : stops) SLF_CHECK(check_stop(stop, annotations));
  return Done{};
}

Result<Done, InputError> check_root(const JsonView& root) {
  SLF_TRY(const JsonView version, root.at("version"));
  SLF_TRY(const double number, version.number());
  if (number != 1) return version.error(shortest(number) + " is not 1");
  SLF_TRY(const JsonItems annotations, entries_of(root, "annotations", kMostAnnotations));
  for (const JsonView each : annotations) SLF_CHECK(check_annotation(each));
  SLF_TRY(const JsonItems tracks, entries_of(root, "tracks", kMostTracks));
  for (const JsonView each : tracks) SLF_CHECK(check_track(each, annotations.size()));
  return Done{};
}

/// A JSON that was read, without the space between its values and without a mark of its encoding.
std::string compact(std::string_view json) {
  if (json.starts_with("\xef\xbb\xbf")) json.remove_prefix(3);
  std::string out;
  bool quoted = false, escaped = false;
  for (const char c : json) {
    if (!quoted && (c == ' ' || c == '\t' || c == '\n' || c == '\r')) continue;
    out += c;
    if (c == '"' && !escaped) quoted = !quoted;
    escaped = quoted && c == '\\' && !escaped;
  }
  return out;
}

}  // namespace

Result<std::string, InputError> checked_notes(const std::string& file,
                                              std::span<const std::uint8_t> json) {
  if (json.size() > kMostNoteBytes)
    return InputError{Errc::kInvalidInput,
                      file + ": more than " + std::to_string(kMostNoteBytes) + " bytes of notes"};
  SLF_TRY(const JsonValue root, parse_json(file, json));
  SLF_CHECK(check_root(JsonView(root, file)));
  return compact({reinterpret_cast<const char*>(json.data()), json.size()});
}

}  // namespace slf
