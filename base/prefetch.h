// SPDX-License-Identifier: Apache-2.0
// Rows of a large array that are soon needed, on their way to the cache.
#pragma once

#include <cstddef>
#include <cstdint>

namespace slf {

/// A hint; what is there is going to be written too.
template <class T>
void prefetch([[maybe_unused]] const T* place) {
#if defined(__GNUC__)
  __builtin_prefetch(place, 1);
#endif
}

/// A hint; the row is going to be written too. Hardware that looks ahead stops at every page.
inline void prefetch_row(const std::int32_t* row, std::size_t lanes) {
  constexpr std::size_t kLine = 64 / sizeof(std::int32_t);
#if defined(__wasm__)  // has no hints: reads of which nobody waits for the values
  for (std::size_t j = 0; j < lanes; j += kLine)
    static_cast<void>(*static_cast<const volatile std::int32_t*>(row + j));
#elif defined(__GNUC__)
  for (std::size_t j = 0; j < lanes; j += kLine) __builtin_prefetch(row + j, 1);
#endif
}

}  // namespace slf
