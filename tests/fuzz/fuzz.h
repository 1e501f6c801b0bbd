// SPDX-License-Identifier: Apache-2.0
// What the targets share. A target is a function of bytes that must return, whatever they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "slf/decoder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace slf::fuzz {

/// How many inputs were read to the end: what a target does behind that, no other input tries.
inline std::size_t accepted_inputs = 0;

/// Counts an input whose result is a value.
template <class Outcome>
void accept(const Outcome& result) {
  accepted_inputs += static_cast<bool>(result);
}

/// The stream with every CRC right, so that the fuzzer reaches the parsers behind them.
std::vector<std::uint8_t> with_sound_crcs(std::span<const std::uint8_t> stream);

/// The same of a stream of frames, of which some begin with a signature.
std::vector<std::uint8_t> with_sound_crcs_of_frames(std::span<const std::uint8_t> stream);

/// Limits within which an input takes a fraction of a second.
DecodeLimits small_limits();

/// A file in memory, for readers that want a path: of this process, gone with it.
class MemoryFile {
 public:
  explicit MemoryFile(std::span<const std::uint8_t> bytes);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::filesystem::path path() const;

 private:
  int fd_;
};

/// The input cut in parts at each byte 0xFF 0xFE 0xFF, so that one input is several files.
std::vector<std::span<const std::uint8_t>> parts_of(std::span<const std::uint8_t> input);

/// A directory of small files on a memory file system; made once, files are written over.
class Directory {
 public:
  Directory();
  ~Directory();
  Directory(const Directory&) = delete;
  Directory& operator=(const Directory&) = delete;
  const std::filesystem::path& path() const { return path_; }
  void write(const std::string& name, std::span<const std::uint8_t> bytes) const;

 private:
  std::filesystem::path path_;
};

}  // namespace slf::fuzz
