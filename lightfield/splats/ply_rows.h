// SPDX-License-Identifier: Apache-2.0
// Rows of the elements of a PLY that is in memory.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/ply_header.h"

namespace slf {

class PlyRows {
 public:
  /// @param bytes  the whole file, kept by reference
  /// @errors kInvalidInput: no PLY, or it announces more than it holds
  static Result<PlyRows, InputError> open(const std::string& name,
                                          std::span<const std::uint8_t> bytes);

  /// Nothing where there is none of the name, or one with lists.
  const PlyElement* element(const std::string& name) const;
  /// Calls visit(row) with the values of every row of an element, in the order of its properties.
  /// @errors kInvalidInput: the file ends before, or has something else than a number; elements
  ///         with lists stand before it
  Result<Done, InputError> for_each(
      const PlyElement& element, const std::function<void(std::span<const double>)>& visit) const;

  const std::string& name() const { return name_; }

 private:
  PlyRows(std::string name, std::span<const std::uint8_t> bytes, PlyHeader header)
      : name_(std::move(name)), bytes_(bytes), header_(std::move(header)) {}

  Result<Done, InputError> for_each_text(
      const PlyElement& element, std::size_t values_before,
      const std::function<void(std::span<const double>)>& visit) const;
  Result<Done, InputError> for_each_binary(
      const PlyElement& element, std::size_t at,
      const std::function<void(std::span<const double>)>& visit) const;
  InputError damaged(const PlyElement& element, std::uint64_t row) const;

  std::string name_;
  std::span<const std::uint8_t> bytes_;
  PlyHeader header_;
};

/// The property of the first of these names that is there.
std::optional<std::size_t> column_of(const PlyElement& element,
                                     std::initializer_list<std::string> names);

}  // namespace slf
