// SPDX-License-Identifier: Apache-2.0
// What names of files say.
#pragma once

#include <filesystem>
#include <string>

namespace slf {

/// In small letters, with its dot: ".ply".
inline std::string extension_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

inline bool is_file(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

}  // namespace slf
