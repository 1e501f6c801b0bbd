// SPDX-License-Identifier: Apache-2.0
// Where the cameras of a plenoptic cloud stand.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "slf/error.h"
#include "slf/types.h"

namespace slf {

/// "comment view 0 1.5 2 3": a line that begins with view or camera and ends in three numbers, in
/// the order of the file. What is between them does not count.
std::vector<Vec3> views_of_comments(const std::vector<std::string>& comments);

/// A list of [x, y, z], or of objects with "position"; or an object whose "views" is one.
/// @errors kUnreadable; kInvalidInput: names file and element
Result<std::vector<Vec3>, InputError> read_views(const std::filesystem::path& file);

}  // namespace slf
