// SPDX-License-Identifier: Apache-2.0
#include "tools/notes_input.h"

#include "slf/capture.h"
#include "slf/notes.h"

namespace slf::tools {

namespace {
constexpr std::size_t kMostNotesOfFile = std::size_t{1} << 19;
}

Result<std::string, Failure> read_notes(const std::string& file) {
  const std::string name = input_name(file);
  SLF_TRY(const auto bytes, from(name, read_file(file, kMostNoteBytes)));
  return from(name, checked_notes(name, bytes));
}

Outcome check_notes_of_file(const std::string& given, const std::string& file,
                            const std::string& notes) {
  if (notes.size() > kMostNotesOfFile)
    return Failure{kUsage, given + " " + file + " is more than " +
                               std::to_string(kMostNotesOfFile) +
                               " bytes: slf html takes them, or the viewer beside the file"};
  return Done{};
}

}  // namespace slf::tools
