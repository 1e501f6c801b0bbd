// SPDX-License-Identifier: Apache-2.0
// Structs that grow: as much of them is read and written as the caller knows of.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace slf::capi {

/// Writes all of `from` but its size that the caller's struct has room for.
template <class Struct>
void give(const Struct& from, Struct* to) {
  const std::size_t size = std::min<std::size_t>(to->size, sizeof(Struct));
  const std::size_t begin = offsetof(Struct, size) + sizeof(to->size);
  if (size > begin)
    std::memcpy(reinterpret_cast<char*>(to) + begin, reinterpret_cast<const char*>(&from) + begin,
                size - begin);
}

/// What the caller knows of is copied, the rest is zero. NULL: all zero.
template <class Struct>
Struct take(const Struct* from) {
  Struct copy{};
  if (from != nullptr) std::memcpy(&copy, from, std::min<std::size_t>(from->size, sizeof(Struct)));
  return copy;
}

}  // namespace slf::capi
