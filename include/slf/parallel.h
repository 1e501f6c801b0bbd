// SPDX-License-Identifier: Apache-2.0
// Work shared by threads in a way that cannot change a result.
#pragma once

#include <cstddef>
#include <functional>

namespace slf {

/// threads <= 0 means all cores; at most one per item.
int thread_count(int threads, std::size_t items);

/// Calls body(begin, end) for consecutive ranges of at most `grain` items that cover [0, items).
/// Each item is given to exactly one call; ranges do not depend on the number of threads. body must
/// write only to what belongs to its items. tick, if given, is called on the calling thread now and
/// then with the number of items done. An exception of body ends the work early and is thrown again
/// here.
void parallel_ranges(std::size_t items, std::size_t grain, int threads,
                     const std::function<void(std::size_t begin, std::size_t end)>& body,
                     const std::function<void(std::size_t done)>& tick = {});

}  // namespace slf
