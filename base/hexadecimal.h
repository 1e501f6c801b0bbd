// SPDX-License-Identifier: Apache-2.0
// Bytes as text.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace slf {

/// Two lower-case digits a byte.
inline std::string hexadecimal(std::span<const std::uint8_t> bytes) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

}  // namespace slf
