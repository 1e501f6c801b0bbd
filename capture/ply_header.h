// SPDX-License-Identifier: Apache-2.0
// The header of a PLY file (Turk 1994): which elements there are and how a row of each is stored.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "slf/error.h"

namespace slf {

enum class PlyType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kFloat,
  kDouble,
};

std::size_t size_of(PlyType type);
/// The word of a header: "uchar".
const char* name_of(PlyType type);
std::optional<PlyType> ply_type_named(std::string_view name);
/// What white space parts.
std::vector<std::string_view> words_of(std::string_view line);

enum class PlyFormat : std::uint8_t { kAscii, kLittleEndian, kBigEndian };

struct PlyProperty {
  std::string name;
  PlyType type{};
  bool is_list = false;
  PlyType count_type{};  ///< of a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  bool has_lists() const;
  /// Bytes that one row takes at the least.
  std::uint64_t min_row_bytes(PlyFormat format) const;
};

struct PlyHeader {
  PlyFormat format{};
  std::vector<PlyElement> elements;
  std::vector<std::string> comments;  ///< without the word comment
  std::size_t body = 0;               ///< offset of the first byte behind the header
};

/// Every count is checked against the bytes that follow the header.
/// @param name  for messages
/// @param head  the beginning of the file, in which the header has to end
/// @param size  bytes of the file
/// @errors kInvalidInput
Result<PlyHeader, InputError> parse_ply_header(const std::string& name,
                                               std::span<const std::uint8_t> head,
                                               std::uint64_t size);

}  // namespace slf
