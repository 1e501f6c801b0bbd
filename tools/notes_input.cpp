// SPDX-License-Identifier: Apache-2.0
#include "tools/notes_input.h"

#include "slf/capture.h"
#include "slf/notes.h"

namespace slf::tools {

Result<std::string, Failure> read_notes(const std::string& file) {
  const std::string name = input_name(file);
  SLF_TRY(const auto bytes, from(name, read_file(file, kMostNoteBytes)));
  return from(name, checked_notes(name, bytes));
}

}  // namespace slf::tools
