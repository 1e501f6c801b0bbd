// SPDX-License-Identifier: Apache-2.0
#include "capture/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <set>
#include <string_view>

namespace slf {

namespace {

struct NamedType {
  std::string_view name;
  PlyType type;
};
constexpr std::array<NamedType, 16> kTypes{{
    {"char", PlyType::kInt8},
    {"int8", PlyType::kInt8},
    {"uchar", PlyType::kUint8},
    {"uint8", PlyType::kUint8},
    {"short", PlyType::kInt16},
    {"int16", PlyType::kInt16},
    {"ushort", PlyType::kUint16},
    {"uint16", PlyType::kUint16},
    {"int", PlyType::kInt32},
    {"int32", PlyType::kInt32},
    {"uint", PlyType::kUint32},
    {"uint32", PlyType::kUint32},
    {"float", PlyType::kFloat},
    {"float32", PlyType::kFloat},
    {"double", PlyType::kDouble},
    {"float64", PlyType::kDouble},
}};

std::optional<PlyFormat> format_named(std::string_view name) {
  if (name == "ascii") return PlyFormat::kAscii;
  if (name == "binary_little_endian") return PlyFormat::kLittleEndian;
  if (name == "binary_big_endian") return PlyFormat::kBigEndian;
  return std::nullopt;
}

// Lines of the header one after the other.
class HeaderParser {
 public:
  HeaderParser(const std::string& name, std::string_view text) : name_(name), text_(text) {}

  Result<PlyHeader, InputError> parse() {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;  // a byte order mark, as of Windows' editors
    if (words_of(next_line()) != std::vector<std::string_view>{"ply"})
      return invalid("not a PLY file");
    bool has_format = false;
    while (at_ < text_.size()) {
      const auto words = words_of(next_line());
      if (!line_ended_) break;
      if (words.empty() || words[0] == "obj_info") continue;
      if (words[0] == "comment") {
        header_.comments.emplace_back(line_.substr(line_.find("comment") + 7));
        continue;
      }
      if (words[0] == "end_header") {
        if (!has_format) return invalid("PLY header without a format");
        header_.body = at_;
        return header_;
      }
      if (words[0] == "format") {
        const auto format = words.size() == 3 ? format_named(words[1]) : std::nullopt;
        if (has_format || !format || words[2] != "1.0") return bad_line();
        header_.format = *format;
        has_format = true;
      } else if (words[0] == "element") {
        SLF_CHECK(element(words));
      } else if (words[0] == "property") {
        SLF_CHECK(property(words));
      } else {
        return bad_line();
      }
    }
    return invalid("PLY header without an end");
  }

 private:
  std::string_view next_line() {
    const std::size_t end = text_.find('\n', at_);
    line_ended_ = end != std::string_view::npos;
    line_ = text_.substr(at_, line_ended_ ? end - at_ : std::string_view::npos);
    at_ = line_ended_ ? end + 1 : text_.size();
    return line_;
  }

  Result<Done, InputError> element(const std::vector<std::string_view>& words) {
    PlyElement element;
    if (words.size() != 3) return bad_line();
    element.name = words[1];
    const auto* end = words[2].data() + words[2].size();
    const auto [stop, error] = std::from_chars(words[2].data(), end, element.count);
    if (error != std::errc() || stop != end) return bad_line();
    if (!names_.insert(element.name).second)
      return invalid("PLY element '" + element.name + "' twice");
    property_names_.clear();
    header_.elements.push_back(std::move(element));
    return Done{};
  }

  Result<Done, InputError> property(const std::vector<std::string_view>& words) {
    const bool is_list = words.size() == 5 && words[1] == "list";
    if (header_.elements.empty() || (words.size() != 3 && !is_list)) return bad_line();
    const auto type = ply_type_named(words[is_list ? 3 : 1]);
    const auto count_type = is_list ? ply_type_named(words[2]) : PlyType::kUint8;
    if (!type || !count_type || *count_type >= PlyType::kFloat) return bad_line();
    auto& properties = header_.elements.back().properties;
    PlyProperty property{std::string(words.back()), *type, is_list, *count_type};
    if (!property_names_.insert(property.name).second)
      return invalid("PLY property '" + property.name + "' twice");
    properties.push_back(std::move(property));
    return Done{};
  }

  InputError invalid(const std::string& cause) const {
    return {Errc::kInvalidInput, name_ + ": " + cause};
  }
  InputError bad_line() const {
    std::string line(line_.substr(0, 80));
    for (char& c : line)
      if (c < ' ' || c > '~') c = '?';
    return invalid("PLY header line not understood: '" + line + "'");
  }

  const std::string& name_;
  std::string_view text_;
  std::string_view line_;
  std::size_t at_ = 0;
  bool line_ended_ = false;
  PlyHeader header_;
  std::set<std::string> names_, property_names_;  // of elements; of the last one's properties
};

}  // namespace

std::optional<PlyType> ply_type_named(std::string_view name) {
  for (const auto& known : kTypes)
    if (known.name == name) return known.type;
  return std::nullopt;
}

const char* name_of(PlyType type) {
  for (const auto& known : kTypes)
    if (known.type == type) return known.name.data();
  return "";
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t begin = line.find_first_not_of(" \t\r", at);
    if (begin == std::string_view::npos) break;
    const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    at = end;
  }
  return words;
}

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat:
      return 4;
    case PlyType::kDouble:
      return 8;
  }
  return 1;
}

bool PlyElement::has_lists() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const PlyProperty& property) { return property.is_list; });
}

std::uint64_t PlyElement::min_row_bytes(PlyFormat format) const {
  // Ascii: a digit for each value. The white space between them is reserve.
  if (format == PlyFormat::kAscii) return properties.size();
  std::uint64_t bytes = 0;
  for (const auto& property : properties)
    bytes += size_of(property.is_list ? property.count_type : property.type);
  return bytes;
}

Result<PlyHeader, InputError> parse_ply_header(const std::string& name,
                                               std::span<const std::uint8_t> head,
                                               std::uint64_t size) {
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  SLF_TRY(PlyHeader header, HeaderParser(name, text).parse());
  std::uint64_t left = std::max<std::uint64_t>(size, head.size()) - header.body;
  for (const auto& element : header.elements) {
    const std::uint64_t row = element.min_row_bytes(header.format);
    if (row == 0) continue;
    if (element.count > left / row)
      return InputError{Errc::kInvalidInput, name + ": PLY announces " +
                                                 std::to_string(element.count) + " of '" +
                                                 element.name + "', more than the file holds"};
    left -= element.count * row;
  }
  return header;
}

}  // namespace slf
