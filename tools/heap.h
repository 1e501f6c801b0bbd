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

/// For memory that nothing was written to yet. Advice that a system does not follow changes
/// nothing.
inline void ask_for_huge_pages([[maybe_unused]] const void* begin,
                               [[maybe_unused]] const void* end) {
#if defined(__GLIBC__) && defined(MADV_HUGEPAGE)
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto first = (reinterpret_cast<std::uintptr_t>(begin) + page - 1) & ~(page - 1);
  const auto last = reinterpret_cast<std::uintptr_t>(end);
  if (first < last)
    static_cast<void>(madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE));
#endif
}

/// For the beginning of main(): the first 64 MiB of malloc's heap are address space taken in one
/// step, resident as they are used, 2 MiB at a time. On small pages a third of a decode was page
/// faults (docs/format-0.4.md). Where the C library is another, or gives less, nothing changes.
inline void heap_on_huge_pages() {
#if defined(__GLIBC__) && defined(MADV_HUGEPAGE)
  constexpr int kHeap = 64 << 20;
  mallopt(M_TOP_PAD, kHeap);
  mallopt(M_TRIM_THRESHOLD, 2 * kHeap);
  mallopt(M_MMAP_THRESHOLD, kHeap / 2);
  const void* const begin = sbrk(0);
  void* volatile grown = std::malloc(1 << 20);  // volatile: or the compiler leaves both out
  std::free(grown);
  ask_for_huge_pages(begin, sbrk(0));
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
