// SPDX-License-Identifier: Apache-2.0
// Colours of a PLY, whose range its types do not tell.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/ply_header.h"

namespace slf {

/// Collects colours as 0 .. 255. Bytes and whole numbers are these; ushort are 0 .. 65535, or bytes
/// where none is more than 255 (as scanners write them); floats 0 .. 1, or 0 .. 255 where one is
/// more than 1. The first samples are stored by the narrower reading of ushort and by 0 .. 1 of
/// floats, from which the other follows exactly when a larger sample comes.
class PlyColours {
 public:
  explicit PlyColours(std::span<const PlyType, 3> types);

  void reserve(std::size_t count) { colours_.reserve(count); }
  /// @return the channel that is out of range; nothing: it was taken
  std::optional<std::size_t> add(std::span<const double, 3> samples);
  /// What to say of the reading that was chosen; or empty.
  std::string warning() const;
  /// An error where no reading fits; or empty.
  std::string problem() const;
  std::vector<std::array<std::uint8_t, 3>> take() { return std::move(colours_); }

 private:
  void read_as_16_bits();
  void read_as_255();

  std::array<PlyType, 3> types_;
  std::vector<std::array<std::uint8_t, 3>> colours_;
  bool wide_is_16_bits_ = false, float_is_255_ = false;
  double largest_float_ = 0, largest_wide_ = 0;
};

}  // namespace slf
