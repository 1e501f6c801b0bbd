// SPDX-License-Identifier: Apache-2.0
#include "slf/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace slf {

int thread_count(int threads, std::size_t items) {
  if (threads <= 0) threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return static_cast<int>(std::clamp<std::size_t>(items, 1, static_cast<std::size_t>(threads)));
}

void parallel_ranges(std::size_t items, std::size_t grain, int threads,
                     const std::function<void(std::size_t, std::size_t)>& body,
                     const std::function<void(std::size_t)>& tick) {
  if (items == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t ranges = (items + grain - 1) / grain;
  std::atomic<std::size_t> next{0}, done{0};
  std::exception_ptr failure;  // std::bad_alloc, or what a body of the caller throws
  std::mutex failure_mutex;
  const auto work = [&](bool reports) {
    try {
      for (std::size_t i; (i = next.fetch_add(1)) < ranges;) {
        const std::size_t end = std::min(items, (i + 1) * grain);
        body(i * grain, end);
        done.fetch_add(end - i * grain);
        if (reports && tick) tick(done.load());
      }
    } catch (...) {
      next.store(ranges);  // nobody begins another range
      const std::lock_guard lock(failure_mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  std::vector<std::thread> pool;
  try {
    for (int t = thread_count(threads, ranges) - 1; t > 0; --t) pool.emplace_back(work, false);
  } catch (const std::system_error&) {  // the system has no more threads: those there are do it
  }
  work(true);
  for (auto& thread : pool) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace slf
