// SPDX-License-Identifier: Apache-2.0
// Twin of base/parallel.cpp for builds with one thread (SLF_THREADS=OFF): the same ranges, one
// after the other.
#include <algorithm>

#include "slf/parallel.h"

namespace slf {

int thread_count(int, std::size_t) { return 1; }

void parallel_ranges(std::size_t items, std::size_t grain, int,
                     const std::function<void(std::size_t, std::size_t)>& body,
                     const std::function<void(std::size_t)>& tick) {
  grain = std::max<std::size_t>(grain, 1);
  for (std::size_t begin = 0; begin < items; begin += std::min(grain, items - begin)) {
    const std::size_t end = begin + std::min(grain, items - begin);
    body(begin, end);
    if (tick) tick(end);
  }
}

}  // namespace slf
