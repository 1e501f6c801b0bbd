// SPDX-License-Identifier: Apache-2.0
// Photographs by the names that files of other programs give them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "slf/capture.h"

namespace slf {

/// `path`, or with an extension of a picture where only that is a file; nothing where none is.
std::optional<std::string> picture_named(const std::filesystem::path& root,
                                         const std::string& path);

/// Where a photograph is, from `root`: by its path, else by its name alone, in the folder itself,
/// in images/ or input/. Paths of other machines, C:\x\a.jpg too, count by their names. Its name
/// alone where it is nowhere.
std::string find_photograph(const std::filesystem::path& root, std::string given);

/// A photograph's file: `image` of the capture, or, of a folder that was named, `name` (with an
/// extension of a picture where it lacks one), else the last part of `image`.
/// @param folder  empty: photographs are in the capture
/// @param label   for messages
/// @errors kInvalidInput: leads out of capture or folder
Result<std::filesystem::path, InputError> photograph_file(const std::filesystem::path& root,
                                                          const std::string& image,
                                                          const std::filesystem::path& folder,
                                                          const std::string& name,
                                                          const std::string& label);

}  // namespace slf
