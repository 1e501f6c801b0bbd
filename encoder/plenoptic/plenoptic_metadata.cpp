// SPDX-License-Identifier: Apache-2.0
#include "encoder/plenoptic/plenoptic_metadata.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include "base/shortest.h"
#include "capture/plenoptic_columns.h"

namespace slf {
namespace {

constexpr const char* kCodingKey = "plenoptic";
constexpr const char* kPropertiesKey = "plenoptic_properties";
constexpr const char* kViewsKey = "plenoptic_views";
constexpr const char* kHoldOutKey = "plenoptic_hold_out";
constexpr const char* kExactKey = "plenoptic_exact";
constexpr const char* kMeanKey = "plenoptic_mean";

std::string_view value_of(const Metadata& metadata, std::string_view key) {
  for (const auto& [name, value] : metadata)
    if (name == key) return value;
  return {};
}

/// Values are lines of words.
std::vector<std::string> words_of_value(std::string_view value) {
  std::string line(value);
  for (char& c : line)
    if (c == '\n') c = ' ';
  const auto words = words_of(line);
  return {words.begin(), words.end()};
}

template <class Number>
bool parse_numbers(std::string_view text, std::vector<Number>& out) {
  for (const std::string& word : words_of_value(text)) {
    Number value{};
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || stop != word.data() + word.size()) return false;
    out.push_back(value);
  }
  return true;
}

InputError damaged(const char* key) {
  return {Errc::kInvalidInput, std::string("metadata ") + key + " is damaged"};
}

Result<Done, InputError> read_properties(std::string_view text, PlenopticRecord& record) {
  const std::vector<std::string> words = words_of_value(text);
  PlyElement vertex{"vertex", 0, {}};
  if (words.size() % 2 != 0) return damaged(kPropertiesKey);
  for (std::size_t i = 0; i < words.size(); i += 2) {
    const auto type = ply_type_named(words[i]);
    if (!type) return damaged(kPropertiesKey);
    record.properties.push_back({words[i], words[i + 1]});
    vertex.properties.push_back({words[i + 1], *type});
  }
  const auto columns = plenoptic_columns(vertex);
  if (!columns || columns->views == 0) return damaged(kPropertiesKey);
  record.views = columns->views;
  record.own_colour = columns->own_colour;
  return Done{};
}

Result<Done, InputError> read_view_positions(std::string_view text, PlenopticRecord& record) {
  std::vector<double> numbers;
  if (!parse_numbers(text, numbers)) return damaged(kViewsKey);
  if (numbers.empty() && record.as == PlenopticCoding::kPlanes) return Done{};
  if (numbers.size() != 3 * record.views) return damaged(kViewsKey);
  for (std::size_t i = 0; i < numbers.size(); i += 3)
    record.view_positions.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  for (const double x : numbers)
    if (!std::isfinite(x)) return damaged(kViewsKey);
  return Done{};
}

}  // namespace

Metadata write_record(const PlenopticRecord& record) {
  std::string properties, views, hold_out;
  for (const PlenopticProperty& p : record.properties)
    properties.append(p.type).append(" ").append(p.name).append("\n");
  for (const Vec3& view : record.view_positions) {
    for (const double x : view) views.append(shortest(x)).append(" ");
    views.back() = '\n';
  }
  for (const int view : record.hold_out) hold_out.append(std::to_string(view)).append(" ");
  Metadata metadata = {
      {kCodingKey, record.as == PlenopticCoding::kViewMaps ? "viewmaps" : "planes"},
      {kPropertiesKey, properties}};
  if (!views.empty()) metadata.emplace_back(kViewsKey, views);
  if (!hold_out.empty()) metadata.emplace_back(kHoldOutKey, hold_out);
  if (record.exact) metadata.emplace_back(kExactKey, "yes");
  if (record.mean) metadata.emplace_back(kMeanKey, "yes");
  return metadata;
}

Result<PlenopticRecord, InputError> read_record(const Metadata& metadata) {
  PlenopticRecord record;
  const std::string_view as = value_of(metadata, kCodingKey);
  if (as != "viewmaps" && as != "planes") return damaged(kCodingKey);
  if (as == "viewmaps") record.as = PlenopticCoding::kViewMaps;
  record.exact = value_of(metadata, kExactKey) == "yes";
  record.mean = value_of(metadata, kMeanKey) == "yes";
  SLF_CHECK(read_properties(value_of(metadata, kPropertiesKey), record));
  if (record.mean && !record.own_colour) return damaged(kMeanKey);
  SLF_CHECK(read_view_positions(value_of(metadata, kViewsKey), record));
  if (!parse_numbers(value_of(metadata, kHoldOutKey), record.hold_out)) return damaged(kHoldOutKey);
  for (const int view : record.hold_out)
    if (view < 0 || static_cast<std::size_t>(view) >= record.views) return damaged(kHoldOutKey);
  return record;
}

bool is_plenoptic(const Metadata& metadata) { return !value_of(metadata, kCodingKey).empty(); }

Result<std::size_t, InputError> count_views_of(const Metadata& metadata) {
  SLF_TRY(const PlenopticRecord record, read_record(metadata));
  return record.views;
}

std::vector<int> held_out_views(const Metadata& metadata) {
  std::vector<int> views;
  parse_numbers(value_of(metadata, kHoldOutKey), views);
  return views;
}

}  // namespace slf
