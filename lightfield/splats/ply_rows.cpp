// SPDX-License-Identifier: Apache-2.0
#include "lightfield/splats/ply_rows.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <limits>

namespace slf {
namespace {

constexpr std::size_t kLongestHeader = std::size_t{1} << 20;  // bytes

/// A value of a binary file.
double number_at(const std::uint8_t* at, PlyType type, bool big_endian) {
  const std::size_t size = size_of(type);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < size; ++i) bits = bits << 8 | at[big_endian ? i : size - 1 - i];
  switch (type) {
    case PlyType::kInt8:
      return static_cast<std::int8_t>(bits);
    case PlyType::kInt16:
      return static_cast<std::int16_t>(bits);
    case PlyType::kInt32:
      return static_cast<std::int32_t>(bits);
    case PlyType::kFloat:
      return double{std::bit_cast<float>(static_cast<std::uint32_t>(bits))};
    case PlyType::kDouble:
      return std::bit_cast<double>(bits);
    case PlyType::kUint8:
    case PlyType::kUint16:
    case PlyType::kUint32:
      break;
  }
  return static_cast<double>(bits);
}

/// Numbers between white space, one after the other.
class TextNumbers {
 public:
  explicit TextNumbers(std::span<const std::uint8_t> bytes)
      : at_(reinterpret_cast<const char*>(bytes.data())), end_(at_ + bytes.size()) {}

  bool next(double& out) {
    while (at_ < end_ && is_space(*at_)) ++at_;
    if (end_ - at_ > 1 && *at_ == '+') ++at_;  // from_chars does not know it
    const auto [stop, error] = std::from_chars(at_, end_, out);
    // What is too large or too small for a double is taken as a splat's own mistake.
    if (error == std::errc::result_out_of_range) out = std::numeric_limits<double>::quiet_NaN();
    if (error == std::errc::invalid_argument || (stop < end_ && !is_space(*stop))) return false;
    at_ = stop;
    return true;
  }

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  const char* at_;
  const char* end_;
};

}  // namespace

Result<PlyRows, InputError> PlyRows::open(const std::string& name,
                                          std::span<const std::uint8_t> bytes) {
  SLF_TRY(
      PlyHeader header,
      parse_ply_header(name, bytes.first(std::min(bytes.size(), kLongestHeader)), bytes.size()));
  return PlyRows(name, bytes, std::move(header));
}

const PlyElement* PlyRows::element(const std::string& name) const {
  for (const PlyElement& element : header_.elements)
    if (element.name == name) return element.has_lists() ? nullptr : &element;
  return nullptr;
}

Result<Done, InputError> PlyRows::for_each(
    const PlyElement& element, const std::function<void(std::span<const double>)>& visit) const {
  const bool text = header_.format == PlyFormat::kAscii;
  std::uint64_t before = 0;  // values of text, or bytes
  for (const PlyElement& other : header_.elements) {
    if (&other == &element) break;
    if (other.has_lists())
      return InputError{Errc::kInvalidInput, name_ + ": PLY element '" + element.name +
                                                 "' stands behind one with lists"};
    before += other.count * other.min_row_bytes(header_.format);  // at most the file's bytes
  }
  if (element.properties.empty()) return Done{};
  if (text) return for_each_text(element, static_cast<std::size_t>(before), visit);
  return for_each_binary(element, header_.body + static_cast<std::size_t>(before), visit);
}

InputError PlyRows::damaged(const PlyElement& element, std::uint64_t row) const {
  return {Errc::kInvalidInput, name_ + ": PLY element '" + element.name + "', row " +
                                   std::to_string(row) + ": a number is expected"};
}

Result<Done, InputError> PlyRows::for_each_text(
    const PlyElement& element, std::size_t values_before,
    const std::function<void(std::span<const double>)>& visit) const {
  TextNumbers numbers(bytes_.subspan(header_.body));
  double ignored = 0;
  for (std::size_t i = 0; i < values_before; ++i)
    if (!numbers.next(ignored)) return damaged(element, 0);
  std::vector<double> row(element.properties.size());
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (double& value : row)
      if (!numbers.next(value)) return damaged(element, i);
    visit(row);
  }
  return Done{};
}

Result<Done, InputError> PlyRows::for_each_binary(
    const PlyElement& element, std::size_t at,
    const std::function<void(std::span<const double>)>& visit) const {
  const bool big_endian = header_.format == PlyFormat::kBigEndian;
  const auto row_bytes = static_cast<std::size_t>(element.min_row_bytes(header_.format));
  std::vector<double> row(element.properties.size());
  for (std::uint64_t i = 0; i < element.count; ++i) {
    if (at > bytes_.size() || row_bytes > bytes_.size() - at) return damaged(element, i);
    const std::uint8_t* from = bytes_.data() + at;
    for (std::size_t k = 0; k < row.size(); ++k) {
      const PlyType type = element.properties[k].type;
      row[k] = number_at(from, type, big_endian);
      from += size_of(type);
    }
    at += row_bytes;
    visit(row);
  }
  return Done{};
}

std::optional<std::size_t> column_of(const PlyElement& element,
                                     std::initializer_list<std::string> names) {
  for (const std::string& name : names)
    for (std::size_t i = 0; i < element.properties.size(); ++i)
      if (element.properties[i].name == name) return i;
  return std::nullopt;
}

}  // namespace slf
