// SPDX-License-Identifier: Apache-2.0
// The program's heap on huge pages.
#pragma once

#if defined(__GLIBC__)
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#endif

namespace slf::tools {

/// For the beginning of main(): the first 64 MiB of malloc's heap are address space taken in one
/// step, resident as they are used, 2 MiB at a time. On small pages a third of a decode was page
/// faults (docs/decisions/008). Where the C library is another, or gives less, nothing changes.
inline void heap_on_huge_pages() {
#if defined(__GLIBC__) && defined(MADV_HUGEPAGE)
  constexpr int kHeap = 64 << 20;
  mallopt(M_TOP_PAD, kHeap);
  mallopt(M_TRIM_THRESHOLD, 2 * kHeap);
  mallopt(M_MMAP_THRESHOLD, kHeap / 2);
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto begin = (reinterpret_cast<std::uintptr_t>(sbrk(0)) + page - 1) & ~(page - 1);
  void* volatile grown = std::malloc(1 << 20);  // volatile: or the compiler leaves both out
  std::free(grown);
  const auto end = reinterpret_cast<std::uintptr_t>(sbrk(0));
  if (begin < end)
    static_cast<void>(madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE));
#endif
}

/// For work whose threads allocate seldom: they too are on that heap, in place of one each. Not for
/// an encode, which takes a quarter longer.
inline void share_heap() {
#if defined(__GLIBC__)
  mallopt(M_ARENA_MAX, 1);
#endif
}

}  // namespace slf::tools
