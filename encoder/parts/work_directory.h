// SPDX-License-Identifier: Apache-2.0
// Directories that the work on a scene is kept in.
#pragma once

#include <filesystem>

#include "slf/error.h"

namespace slf {

/// Made where it is missing.
/// @errors kUnwritable
inline Result<Done, InputError> make_directory(const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (!error) return Done{};
  return InputError{Errc::kUnwritable, directory.string() + ": " + error.message()};
}

}  // namespace slf
