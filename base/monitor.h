// SPDX-License-Identifier: Apache-2.0
// What several threads change and wait for; nothing of it where a build has one thread.
#pragma once

#if !defined(SLF_SERIAL)
#include <condition_variable>
#include <mutex>
#endif

namespace slf {

#if defined(SLF_SERIAL)

/// Whoever waits does so for what was done before it.
class Monitor {
 public:
  template <class Change>
  void change(const Change& change) {
    change();
  }
  template <class Holds>
  void wait(const Holds& holds) {
    holds();
  }
};

#else

class Monitor {
 public:
  /// Changes what others read or wait for.
  template <class Change>
  void change(const Change& change) {
    {
      const std::lock_guard lock(mutex_);
      change();
    }
    changed_.notify_all();
  }

  /// Returns when it holds.
  template <class Holds>
  void wait(const Holds& holds) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, holds);
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
};

#endif

}  // namespace slf
