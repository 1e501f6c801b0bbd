// SPDX-License-Identifier: Apache-2.0
#include "tools/npy.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <string_view>

namespace slf::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "elements are copied as they are");

constexpr std::string_view kMagic("\x93NUMPY", 6);

InputError invalid_array(std::string cause) { return {Errc::kInvalidInput, std::move(cause)}; }

/// The text after "'key':" in the header's dictionary, blanks skipped; empty if there is none.
/// @param quoted  the key with its quotes
std::string_view value_of(std::string_view header, std::string_view quoted) {
  std::size_t at = header.find(quoted);
  if (at == std::string_view::npos) return {};
  at = header.find(':', at + quoted.size());
  if (at == std::string_view::npos) return {};
  at = header.find_first_not_of(' ', at + 1);
  return at == std::string_view::npos ? std::string_view{} : header.substr(at);
}

Result<Done, InputError> parse_type(std::string_view header, NpyArray& array) {
  const std::string_view descr = value_of(header, "'descr'");
  if (descr.size() < 5 || descr[0] != '\'' || descr[4] != '\'')
    return invalid_array("not an array of plain numbers");
  const std::string type(descr.substr(1, 3));
  array.kind = type[1];
  array.size = type[2] - '0';
  const bool known = (type[1] == 'i' || type[1] == 'u') &&
                     (array.size == 1 || array.size == 2 || array.size == 4 || array.size == 8);
  const bool real = type[1] == 'f' && (array.size == 4 || array.size == 8);
  if (!known && !real) return invalid_array("elements of type " + type + " are not read");
  if (type[0] != '<' && type[0] != '|')
    return invalid_array("elements of type " + type + " are not little endian");
  const std::string_view order = value_of(header, "'fortran_order'");
  if (order.substr(0, 5) != "False")
    return invalid_array("not in C order (save numpy.ascontiguousarray)");
  return Done{};
}

Result<Done, InputError> parse_shape(std::string_view header, NpyArray& array) {
  std::string_view shape = value_of(header, "'shape'");
  const std::size_t close = shape.find(')');
  if (shape.empty() || shape[0] != '(' || close == std::string_view::npos)
    return invalid_array("the header has no shape");
  shape = shape.substr(1, close - 1);
  while (true) {
    while (!shape.empty() && (shape[0] == ' ' || shape[0] == ',')) shape.remove_prefix(1);
    if (shape.empty()) return Done{};
    std::size_t extent = 0;
    const auto [end, error] = std::from_chars(shape.data(), shape.data() + shape.size(), extent);
    if (error != std::errc() || array.shape.size() == 8)
      return invalid_array("the header's shape is not readable");
    array.shape.push_back(extent);
    shape.remove_prefix(static_cast<std::size_t>(end - shape.data()));
  }
}

/// Whether shape times size is exactly the bytes present, without overflow.
bool fills(const NpyArray& array, std::size_t bytes) {
  if (bytes % static_cast<std::size_t>(array.size) != 0) return false;
  const std::size_t present = bytes / static_cast<std::size_t>(array.size);
  if (std::find(array.shape.begin(), array.shape.end(), 0u) != array.shape.end())
    return present == 0;
  std::size_t count = 1;
  for (const std::size_t extent : array.shape) {
    if (count > present / extent) return false;
    count *= extent;
  }
  return count == present;
}

template <class T>
Result<std::vector<std::int32_t>, InputError> converted(const NpyArray& array) {
  std::vector<std::int32_t> out(array.count());
  const std::uint8_t* from = array.bytes.data() + array.first;
  for (std::int32_t& value : out) {
    T element;
    std::memcpy(&element, from, sizeof element);
    from += sizeof element;
    // NOLINTNEXTLINE(bugprone-signed-char-misuse): an int8 keeps its sign.
    value = static_cast<std::int32_t>(element);
    if (static_cast<T>(value) != element || (value < 0) != (element < T{0}))
      return invalid_array("a value does not fit 32 bits");
  }
  return out;
}

std::string head_of(const std::vector<std::size_t>& shape, const char* descr) {
  std::string dictionary = "{'descr': '";
  dictionary.append(descr).append("', 'fortran_order': False, 'shape': (");
  for (std::size_t i = 0; i < shape.size(); ++i)
    dictionary.append(i == 0 ? "" : " ").append(std::to_string(shape[i])).append(",");
  dictionary.append("), }");
  // The elements start at a multiple of 64.
  dictionary.append((64 - (kMagic.size() + 4 + dictionary.size() + 1) % 64) % 64, ' ').append("\n");
  std::string head(kMagic);
  head.append({'\1', '\0', static_cast<char>(dictionary.size() & 255),
               static_cast<char>(dictionary.size() >> 8)});
  return head + dictionary;
}

}  // namespace

std::size_t NpyArray::count() const {
  std::size_t product = 1;
  for (const std::size_t extent : shape) product *= extent;
  return product;
}

Result<NpyArray, InputError> parse_npy(std::vector<std::uint8_t> file) {
  if (file.size() < 10 || std::memcmp(file.data(), kMagic.data(), kMagic.size()) != 0)
    return invalid_array("not a .npy file");
  const int version = file[6];
  if (version != 1 && version != 2)
    return invalid_array("version " + std::to_string(version) + " of .npy is not read");
  std::size_t header = 10, length = file[8] | std::size_t{file[9]} << 8;
  if (version == 2) {
    if (file.size() < 12) return invalid_array("truncated .npy header");
    header = 12;
    length |= std::size_t{file[10]} << 16 | std::size_t{file[11]} << 24;
  }
  if (length > file.size() - header) return invalid_array("truncated .npy header");
  const std::string_view text(reinterpret_cast<const char*>(file.data()) + header, length);
  NpyArray array;
  SLF_CHECK(parse_type(text, array));
  SLF_CHECK(parse_shape(text, array));
  array.first = header + length;
  if (!fills(array, file.size() - array.first))
    return invalid_array("the .npy shape does not agree with the bytes present");
  array.bytes = std::move(file);
  return array;
}

Result<std::vector<std::int32_t>, InputError> int32_values(const NpyArray& array) {
  if (array.kind == 'f') return invalid_array("integers are needed, the array holds floats");
  const bool is_signed = array.kind == 'i';
  switch (array.size) {
    case 1:
      return is_signed ? converted<std::int8_t>(array) : converted<std::uint8_t>(array);
    case 2:
      return is_signed ? converted<std::int16_t>(array) : converted<std::uint16_t>(array);
    case 4:
      return is_signed ? converted<std::int32_t>(array) : converted<std::uint32_t>(array);
    default:
      return is_signed ? converted<std::int64_t>(array) : converted<std::uint64_t>(array);
  }
}

NpyFile npy_file(const std::vector<std::size_t>& shape, std::span<const std::int32_t> values) {
  return {head_of(shape, "<i4"), std::as_bytes(values)};
}

NpyFile npy_file(const std::vector<std::size_t>& shape, std::span<const std::uint16_t> values) {
  return {head_of(shape, "<u2"), std::as_bytes(values)};
}

NpyFile npy_file(const std::vector<std::size_t>& shape, std::span<const float> values) {
  return {head_of(shape, "<f4"), std::as_bytes(values)};
}

}  // namespace slf::tools
