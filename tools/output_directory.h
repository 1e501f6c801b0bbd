// SPDX-License-Identifier: Apache-2.0
// A directory of results that appears whole or not at all.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/failure.h"

namespace slf::tools {

/// Calls write(D) with a new directory D beside `directory`, then puts D in its place. Where that
/// is there already, and holds nothing but files of `names`, both are exchanged and the old one
/// removed; where it holds others too, the files are moved into it one by one, `names.back()` last
/// and its old one removed first, so that what has that file is of one piece. After an error, and
/// where it is interrupted, nothing has changed.
/// @param names  of the files that write() may make
Outcome save_directory(const std::string& directory, const std::vector<std::string>& names,
                       const std::function<Outcome(const std::string& directory)>& write);

}  // namespace slf::tools
