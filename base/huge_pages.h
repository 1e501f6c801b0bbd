// SPDX-License-Identifier: Apache-2.0
// Large arrays on large pages, where the system has them and asks to be told.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace slf {

/// For memory that nothing was written to yet. Page faults and address translation of 133 MB on
/// small pages were a seventh of the time of a decode.
inline void advise_huge_pages([[maybe_unused]] const void* memory,
                              [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
  constexpr std::uintptr_t kHugePage = std::uintptr_t{1} << 21;
  const auto begin = reinterpret_cast<std::uintptr_t>(memory);
  const auto first = (begin + kHugePage - 1) & ~(kHugePage - 1);
  const auto end = (begin + bytes) & ~(kHugePage - 1);
  if (first < end)  // advice that a system does not follow changes nothing
    static_cast<void>(madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE));
#endif
}

/// Room for `size` values, on huge pages; where values have to move, for half as many again.
template <class T>
void reserve_large(std::vector<T>& values, std::size_t size) {
  if (size <= values.capacity()) return;
  values.reserve(std::max(size, values.capacity() + values.capacity() / 2));
  advise_huge_pages(values.data(), values.capacity() * sizeof(T));
}

}  // namespace slf
