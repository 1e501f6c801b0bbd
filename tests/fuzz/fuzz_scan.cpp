// SPDX-License-Identifier: Apache-2.0
// Scans: LAS, and E57 whose length and checksums are made right.
#include <algorithm>

#include "capture/e57_reader.h"
#include "capture/las_reader.h"
#include "tests/fuzz/fuzz.h"

namespace {

constexpr std::size_t kE57Header = 48, kLength = 16, kPage = 40, kChecksum = 4, kMostPage = 4096;

std::uint32_t crc32c(std::span<const std::uint8_t> bytes) {
  std::uint32_t value = ~0u;
  for (const std::uint8_t byte : bytes) {
    value ^= byte;
    for (int bit = 0; bit < 8; ++bit) value = value >> 1 ^ ((value & 1) != 0 ? 0x82F63B78u : 0u);
  }
  return ~value;
}

/// Whole pages of 64 to 4,096 bytes, each with its checksum.
void make_sound(std::vector<std::uint8_t>& file) {
  const std::size_t page = std::clamp(std::size_t{file[kPage]} | std::size_t{file[kPage + 1]} << 8,
                                      std::size_t{64}, kMostPage);
  file.resize((file.size() + page - 1) / page * page);
  for (std::size_t i = 0; i < 8; ++i) {
    file[kPage + i] = static_cast<std::uint8_t>(page >> (8 * i));
    file[kLength + i] = static_cast<std::uint8_t>(file.size() >> (8 * i));
  }
  for (std::size_t at = 0; at < file.size(); at += page) {
    const std::size_t end = at + page - kChecksum;
    const std::uint32_t crc = crc32c(std::span(file).subspan(at, page - kChecksum));
    for (std::size_t i = 0; i < kChecksum; ++i)
      file[end + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::uint8_t> file(data, data + size);
  const bool e57 = size >= kE57Header && data[0] == 'A';
  if (e57) make_sound(file);
  const slf::fuzz::MemoryFile scan(file);
  std::vector<std::string> warnings;
  if (e57)
    slf::fuzz::accept(slf::read_e57(scan.path(), &warnings));
  else if (slf::is_plain_las(scan.path()))
    slf::fuzz::accept(slf::read_las(scan.path(), &warnings));
  return 0;
}
