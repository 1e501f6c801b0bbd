// SPDX-License-Identifier: Apache-2.0
// Files that are read one block after the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "capture/descriptor.h"
#include "slf/error.h"

namespace slf {

/// What is no regular file, as a pipe, is held whole: its size is known too.
class InputFile {
 public:
  static constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 32;

  /// "-" is standard input.
  /// @param max_held  bytes, of what is no regular file
  /// @errors kUnreadable: not there, a directory, a device or pipe that the caller did not open;
  ///         kLimitExceeded: it gives more than max_held
  static Result<InputFile, InputError> open(const std::filesystem::path& file,
                                            std::uint64_t max_held = kMostBytes);

  /// Bytes when it was opened.
  std::uint64_t size() const { return size_; }
  /// Fills the span as far as there is something.
  /// @return how much; less than the span at the end
  /// @errors kUnreadable
  Result<std::size_t, InputError> read(std::span<std::uint8_t> to);
  /// All that is left.
  /// @errors kUnreadable; kLimitExceeded: more than max_bytes
  Result<std::vector<std::uint8_t>, InputError> read_rest(std::uint64_t max_bytes);

 private:
  InputFile(Descriptor in, std::filesystem::path name)
      : in_(std::move(in)), name_(std::move(name)) {}

  Descriptor in_;
  std::filesystem::path name_;  // for messages
  std::uint64_t size_ = 0;
  bool held_ = false;
  std::vector<std::uint8_t> content_;  // of what is held
  std::size_t given_ = 0;              // of it
};

}  // namespace slf
