// SPDX-License-Identifier: Apache-2.0
// The rows behind the header of a PLY file, one block of it after the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "capture/input_file.h"
#include "capture/ply_header.h"

namespace slf {

/// Values one after the other. Every read is checked against the end.
class PlyBody {
 public:
  /// @param file   kept by reference
  /// @param bytes  the block of the file that is read already
  /// @param at     in it, where the body begins
  PlyBody(InputFile& file, std::vector<std::uint8_t> bytes, std::size_t at, PlyFormat format)
      : file_(file), bytes_(std::move(bytes)), format_(format), at_(at) {}

  bool value(PlyType type, double& out) {
    return format_ == PlyFormat::kAscii ? text(out) : binary(type, out);
  }

  /// How many items a list has; they follow.
  bool list_length(const PlyProperty& property, std::uint64_t& items);
  /// Over a whole list.
  bool skip_list(const PlyProperty& property);
  bool skip(std::uint64_t bytes);
  /// Over all rows of an element.
  bool skip_element(const PlyElement& element);

 private:
  bool binary(PlyType type, double& out);
  bool text(double& out);
  std::size_t left() const { return bytes_.size() - at_; }  // of the block
  /// As many bytes are in the block, or all that the file has left.
  bool has(std::size_t bytes) { return left() >= bytes || fill(bytes); }
  bool fill(std::size_t bytes);

  InputFile& file_;
  std::vector<std::uint8_t> bytes_;  // a block of the file
  PlyFormat format_;
  std::size_t at_;
  bool ended_ = false;  // nothing is behind the block
};

}  // namespace slf
