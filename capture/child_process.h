// SPDX-License-Identifier: Apache-2.0
// Other programs: what they do with files that have no name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "capture/descriptor.h"
#include "slf/error.h"

namespace slf {

/// A temporary file that nobody has to remove, whatever happens.
class UnnamedFile {
 public:
  /// @errors kUnwritable
  static Result<UnnamedFile, InputError> create();

  int descriptor() const { return file_.get(); }
  /// For this process, and for those that it starts: opened, it is read from its beginning.
  std::filesystem::path path() const { return "/dev/fd/" + std::to_string(file_.get()); }

 private:
  explicit UnnamedFile(Descriptor file) : file_(std::move(file)) {}

  Descriptor file_;
};

/// Runs a program that is looked for in PATH, without a shell, with nothing on its standard input,
/// and waits for it. words: its name and its arguments. One at a time.
/// @return its exit code; 128 and more where a signal ended it
/// @errors kUnsupported: there is no such program; kUnreadable: it can not be started
Result<int, InputError> run_program(const std::vector<std::string>& words,
                                    const UnnamedFile& output, const UnnamedFile& errors);

}  // namespace slf
