// The rows behind the header of a PLY file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "capture/ply_header.h"

namespace slf {

/// Values one after the other. Every read is checked against the end.
class PlyBody {
 public:
  PlyBody(std::span<const std::uint8_t> bytes, PlyFormat format) : bytes_(bytes), format_(format) {}

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

  std::span<const std::uint8_t> bytes_;
  PlyFormat format_;
  std::size_t at_ = 0;
};

}  // namespace slf
