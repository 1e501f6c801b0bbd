// SPDX-License-Identifier: Apache-2.0
// The binary part of E57: pages with checksums, and sections of packed columns.
// Source: ASTM E2807-11, 7 (pages), 9 (compressed vectors), as libE57Format writes them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "slf/error.h"

namespace slf {

/// How the values of a column are stored.
struct E57Column {
  enum class Kind : std::uint8_t { kInteger, kSingle, kDouble };

  std::string name;
  Kind kind = Kind::kInteger;
  std::int64_t minimum = 0, maximum = 0;  ///< kInteger: stored is the value less the minimum
  double scale = 1, offset = 0;           ///< kInteger

  int bits() const;  ///< of a value, 0 .. 64
};

/// The columns of one cloud as they were packed.
class E57Columns {
 public:
  std::size_t rows() const { return rows_; }
  /// @param row  < rows()
  double value(std::size_t column, std::size_t row) const;

 private:
  friend class E57File;
  std::vector<E57Column> columns_;
  std::vector<std::vector<std::uint8_t>> packed_;  // [columns]
  std::size_t rows_ = 0;
};

class E57File {
 public:
  /// Reads all of it: a file takes its size in memory.
  /// @errors kUnreadable; kLimitExceeded: over 4 GiB; kInvalidInput: no E57, cut off, or a page
  ///         with another checksum
  static Result<E57File, InputError> open(const std::filesystem::path& file);

  std::span<const std::uint8_t> xml() const;
  /// @param offset  of a compressed vector: where its section is, in the file's own bytes
  /// @errors kInvalidInput: less than `rows` values of a column, or than a byte a row; sections
  /// that
  ///         overlap, so that all of them together are O(file)
  Result<E57Columns, InputError> read(std::uint64_t offset, std::uint64_t rows,
                                      std::vector<E57Column> columns);

 private:
  Result<std::span<const std::uint8_t>, InputError> from(std::uint64_t offset) const;
  InputError invalid(const std::string& cause) const;

  std::string name_;
  std::vector<std::uint8_t> bytes_;  // of all pages, without checksums
  std::uint64_t page_ = 0, xml_offset_ = 0, xml_bytes_ = 0;
  std::uint64_t left_ = 0;  // bytes that no section was read of yet
};

}  // namespace slf
