// SPDX-License-Identifier: Apache-2.0
// Numbers of files that are little endian.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace slf {

/// @param at  with sizeof(T) bytes behind it
template <class T>
T little(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::make_unsigned_t<T> value = 0;
  for (std::size_t i = sizeof(T); i-- > 0;)
    value = static_cast<decltype(value)>(value << 8 | bytes[at + i]);
  return static_cast<T>(value);
}

inline double little_double(std::span<const std::uint8_t> bytes, std::size_t at) {
  return std::bit_cast<double>(little<std::uint64_t>(bytes, at));
}

inline float little_float(std::span<const std::uint8_t> bytes, std::size_t at) {
  return std::bit_cast<float>(little<std::uint32_t>(bytes, at));
}

}  // namespace slf
