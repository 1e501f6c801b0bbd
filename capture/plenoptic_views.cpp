// SPDX-License-Identifier: Apache-2.0
#include "capture/plenoptic_views.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "capture/json_numbers.h"
#include "capture/ply_header.h"
#include "slf/capture.h"

namespace slf {

namespace {

std::optional<double> number_in_word(std::string_view word) {
  double value = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || stop != word.data() + word.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

bool names_a_view(std::string_view word) {
  std::string small(word.substr(0, 6));
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return small.starts_with("view") || small == "camera";
}

}  // namespace

std::vector<Vec3> views_of_comments(const std::vector<std::string>& comments) {
  std::vector<Vec3> views;
  for (const std::string& comment : comments) {
    const auto words = words_of(comment);
    if (words.size() < 4 || !names_a_view(words[0])) continue;
    Vec3 view{};
    bool whole = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto value = number_in_word(words[words.size() - 3 + k]);
      whole = whole && value;
      if (value) view[k] = *value;
    }
    if (whole) views.push_back(view);
  }
  return views;
}

Result<std::vector<Vec3>, InputError> read_views(const std::filesystem::path& file) {
  SLF_TRY(const auto text, read_file(file, kMaxJsonBytes));
  SLF_TRY(const JsonValue value, parse_json(file.string(), text));
  const JsonView root(value, file.string());
  const auto named = root.find("views");
  SLF_TRY(const auto items, named ? named->items() : root.items());
  std::vector<Vec3> views;
  for (const JsonView& item : items) {
    const auto position = item.find("position");
    SLF_TRY(const auto view, json_vector<3>(position ? *position : item));
    views.push_back(view);
  }
  return views;
}

}  // namespace slf
