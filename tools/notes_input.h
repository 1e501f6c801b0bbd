// SPDX-License-Identifier: Apache-2.0
// Notes that are given to a verb, checked.
#pragma once

#include <string>

#include "tools/failure.h"

namespace slf::tools {

/// The JSON of docs/notes.md, without space between its values. "-" is standard input.
Result<std::string, Failure> read_notes(const std::string& file);

/// Whether notes may be kept in a file, which has room for 1 MiB of metadata.
/// @param given  the verb and the option, for the message
Outcome check_notes_of_file(const std::string& given, const std::string& file,
                            const std::string& notes);

}  // namespace slf::tools
