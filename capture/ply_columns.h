// SPDX-License-Identifier: Apache-2.0
// What the properties of a PLY's vertices are to a point cloud.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "capture/ply_header.h"

namespace slf {

inline constexpr std::array<const char*, 9> kPlyWanted{"x",  "y",   "z",     "nx",  "ny",
                                                       "nz", "red", "green", "blue"};
inline constexpr std::size_t kPlyNormal = 3, kPlyColour = 6;  // where they begin in kPlyWanted

/// Where each property of the vertex goes; which of the optional groups are there in full.
struct PlyColumns {
  std::vector<std::optional<std::size_t>> wanted;  ///< [properties] index into kPlyWanted
  std::array<PlyType, kPlyWanted.size()> type{};
  std::array<bool, kPlyWanted.size()> present{};
  bool normals = false, colours = false;
  bool exact = false;                 ///< of x, y, z one may have more digits than a float
  std::vector<std::string> warnings;  ///< of what is skipped, without the file's name
};

/// By name. Other programs' names (Red, diffuse_red, r; normal_x) count where all three of a kind
/// are there and ours are not.
PlyColumns ply_columns(const PlyElement& vertex);

}  // namespace slf
