// SPDX-License-Identifier: Apache-2.0
// Notes that are given to a verb, checked.
#pragma once

#include <string>

#include "tools/failure.h"

namespace slf::tools {

/// The JSON of docs/notes.md, without space between its values. "-" is standard input.
Result<std::string, Failure> read_notes(const std::string& file);

}  // namespace slf::tools
