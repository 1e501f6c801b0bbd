// SPDX-License-Identifier: Apache-2.0
// Standard input as a file: for readers that look at a name and read more than once.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tools/failure.h"

namespace slf::tools {

/// A file in a directory of its own beneath that of temporary files (TMPDIR). Both go with it, and
/// with an interrupt. One lives at a time.
class SpooledInput {
 public:
  /// The number of what the caller has opened: 0 of "-" and /dev/stdin, N of /dev/fd/N, which a
  /// shell makes of <(command). Nothing: the name of a file.
  static std::optional<int> stream_of(const std::string& name);

  /// All of such a stream, which messages call standard input. What it holds is told by its first
  /// bytes, and its name ends as readers expect it: "standard input.ply".
  /// @errors kInputInvalid: not a PLY, LAS, E57, STL, GLB or a file of splats; kLimitExceeded: more
  ///         than 4 GiB; kWriteFailed: no room for it
  static Result<SpooledInput, Failure> read(int stream);

  SpooledInput(SpooledInput&& other) noexcept;
  SpooledInput& operator=(SpooledInput&&) = delete;
  ~SpooledInput();

  std::string path() const { return file_.string(); }
  /// A sentence with "standard input" in the place of the path of the one that lives.
  static std::string named(std::string sentence);

 private:
  explicit SpooledInput(std::filesystem::path directory) : directory_(std::move(directory)) {}

  std::filesystem::path directory_, file_;  // empty: moved from
};

}  // namespace slf::tools
