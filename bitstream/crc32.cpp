// SPDX-License-Identifier: Apache-2.0
#include "bitstream/crc32.h"

#include <array>
#include <cstddef>

namespace slf {
namespace {

constexpr std::uint32_t kPolynomial = 0xEDB88320;  // of ISO 3309, lowest power first
constexpr std::size_t kSlices = 8;                 // bytes a round

/// [n][byte] remainder of a byte with n zero bytes behind it. Made when first needed: as constants
/// the 8 kB would be a tenth of a decoder that is sent over a network.
using Tables = std::array<std::array<std::uint32_t, 256>, kSlices>;

Tables make_tables() {
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) rest = rest >> 1 ^ (rest & 1 ? kPolynomial : 0);
    tables[0][byte] = rest;
  }
  for (std::size_t n = 1; n < kSlices; ++n)
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[n - 1][byte];
      tables[n][byte] = before >> 8 ^ tables[0][before & 0xFF];
    }
  return tables;
}

}  // namespace

std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc) {
  static const Tables tables = make_tables();
  crc = ~crc;
  for (; bytes.size() >= kSlices; bytes = bytes.subspan(kSlices)) {
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < kSlices; ++i) {
      const std::uint32_t from_crc = i < 4 ? crc >> (8 * i) : 0;
      next ^= tables[kSlices - 1 - i][(bytes[i] ^ from_crc) & 0xFF];
    }
    crc = next;
  }
  for (const std::uint8_t byte : bytes) crc = crc >> 8 ^ tables[0][(crc ^ byte) & 0xFF];
  return ~crc;
}

}  // namespace slf
