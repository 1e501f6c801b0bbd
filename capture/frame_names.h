// SPDX-License-Identifier: Apache-2.0
// Names of files that have the number of a frame in them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace slf {

inline constexpr std::uint32_t kMostFrameNumber = 999'999'999;

/// What stands before and behind the number of a frame, and how the number is padded.
struct FramePattern {
  std::string before, behind;
  std::size_t width = 1;  ///< digits, at least

  std::string name_of(std::uint32_t number) const;
  /// What parse_pattern reads: "frame_%04d.ply".
  std::string text() const;
  /// The number of a name that fits; more digits than the width do, without zeros in front.
  std::optional<std::uint32_t> number_of(std::string_view name) const;
};

/// Reads "frame_%04d.ply": one of %d, %4d and %04d; nothing where there is none, or anything else
/// with a percent sign.
std::optional<FramePattern> parse_pattern(std::string_view name);
/// The pattern that a name is of, by the digits that its stem ends in: "loot_vox10_1000.ply" is of
/// "loot_vox10_%04d.ply". Nothing without digits, or with more than nine.
std::optional<FramePattern> pattern_of(std::string_view stem, std::string_view extension);

}  // namespace slf
