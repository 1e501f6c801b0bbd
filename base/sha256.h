// SPDX-License-Identifier: Apache-2.0
// SHA-256 (FIPS 180-4), for the digests of decoded integers.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace slf {

class Sha256 {
 public:
  void update(std::span<const std::uint8_t> bytes);
  std::array<std::uint8_t, 32> finish();

 private:
  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> block_{};
  std::uint64_t bytes_ = 0;
};

}  // namespace slf
