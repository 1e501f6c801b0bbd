// SPDX-License-Identifier: Apache-2.0
// Work that Ctrl-C ends.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace slf::python {

/// Calls work() on a thread of its own, without Python's lock. If Python is interrupted meanwhile,
/// `ended` is set, which work() is to look at, and what Python raised is thrown when it returns.
/// Python handles signals in its main thread alone: called from another, this waits for work().
/// @throws what work() throws; std::system_error where there is no thread for it
template <class Work>
void run_interruptibly(std::atomic<bool>& ended, const Work& work) {
  constexpr std::chrono::milliseconds kLook{50};
  std::exception_ptr raised, failed;
  {
    const pybind11::gil_scoped_release no_gil;
    std::mutex mutex;
    std::condition_variable changed;
    bool done = false;
    std::thread worker([&] {
      try {
        work();
      } catch (...) {
        failed = std::current_exception();
      }
      const std::lock_guard lock(mutex);
      done = true;
      changed.notify_one();
    });
    std::unique_lock lock(mutex);
    while (!changed.wait_for(lock, kLook, [&] { return done; })) {
      lock.unlock();
      if (!raised) {
        const pybind11::gil_scoped_acquire gil;
        if (PyErr_CheckSignals() != 0) {
          raised = std::make_exception_ptr(pybind11::error_already_set());
          ended = true;
        }
      }
      lock.lock();
    }
    lock.unlock();
    worker.join();
  }
  if (raised) std::rethrow_exception(raised);
  if (failed) std::rethrow_exception(failed);
}

}  // namespace slf::python
