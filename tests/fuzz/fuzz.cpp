// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/fuzz.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>

#include "bitstream/crc32.h"

namespace slf::fuzz {

namespace {

/// Mends the checksums of units from `at` on, up to bytes that are none.
/// @param signatures  some units stand behind another signature
void mend_crcs(std::vector<std::uint8_t>& stream, std::size_t at, bool signatures) {
  while (at + 6 <= stream.size()) {
    if (signatures && stream[at] == 0x8B) {
      at += 8;
      continue;
    }
    std::size_t length = 0, p = at + (stream[at] == 1 ? 3 : 1);  // a sequence has its version there
    for (int shift = 0; p < stream.size() && shift < 42; shift += 7) {
      length |= std::size_t{stream[p] & 0x7Fu} << shift;
      if (!(stream[p++] & 0x80)) break;
    }
    if (stream.size() - p < 4 || length > stream.size() - p - 4) return;
    const std::uint32_t crc = crc32(std::span(stream).subspan(at, p + length - at));
    for (std::size_t i = 0; i < 4; ++i)
      stream[p + length + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
    at = p + length + 4;
  }
}

}  // namespace

std::vector<std::uint8_t> with_sound_crcs(std::span<const std::uint8_t> input) {
  std::vector<std::uint8_t> stream(input.begin(), input.end());
  mend_crcs(stream, 8, false);
  return stream;
}

std::vector<std::uint8_t> with_sound_crcs_of_frames(std::span<const std::uint8_t> input) {
  std::vector<std::uint8_t> stream(input.begin(), input.end());
  mend_crcs(stream, 8, true);
  return stream;
}

DecodeLimits small_limits() {
  DecodeLimits limits;
  limits.max_points = 1 << 12;
  limits.max_memory = 1 << 25;
  limits.max_work = 1 << 23;
  return limits;
}

MemoryFile::MemoryFile(std::span<const std::uint8_t> bytes) : fd_(memfd_create("fuzz", 0)) {
  if (fd_ < 0 || ::write(fd_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
    std::abort();
}

MemoryFile::~MemoryFile() { ::close(fd_); }

std::filesystem::path MemoryFile::path() const { return "/proc/self/fd/" + std::to_string(fd_); }

std::vector<std::span<const std::uint8_t>> parts_of(std::span<const std::uint8_t> input) {
  constexpr std::array<std::uint8_t, 3> kMark = {0xFF, 0xFE, 0xFF};
  std::vector<std::span<const std::uint8_t>> parts;
  for (auto begin = input.begin();;) {
    const auto end = std::search(begin, input.end(), kMark.begin(), kMark.end());
    parts.emplace_back(begin, end);
    if (end == input.end()) return parts;
    begin = end + kMark.size();
  }
}

Directory::Directory() {
  std::string name =
      (std::filesystem::exists("/dev/shm") ? std::string("/dev/shm") : std::string("/tmp")) +
      "/slf-fuzz-XXXXXX";
  if (mkdtemp(name.data()) == nullptr) std::abort();
  path_ = name;
}

Directory::~Directory() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

void Directory::write(const std::string& name, std::span<const std::uint8_t> bytes) const {
  std::ofstream(path_ / name, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

}  // namespace slf::fuzz
