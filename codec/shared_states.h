// What slice 0 leaves after each of its units, for the slices that start from it. Spec 7.3, 8.2.1.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <vector>

namespace slf {

/// Slice 0 is worked on by one thread while others wait for what they need of it. Whoever runs the
/// slices has to begin with slice 0.
template <class States>
class SharedStates {
 public:
  /// units: the most that slice 0 has.
  explicit SharedStates(std::size_t units) : states_(units) {}

  void publish(std::size_t unit, const States& states) {
    {
      const std::lock_guard lock(mutex_);
      states_[unit] = states;
    }
    changed_.notify_all();
  }

  /// Nothing else will be published.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_all();
  }

  /// @return those after the unit of slice 0; nullptr where it failed before.
  const States* wait(std::size_t unit) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_ || states_[unit].has_value(); });
    return states_[unit] ? &*states_[unit] : nullptr;
  }

 private:
  std::vector<std::optional<States>> states_;  // [units] once set, never changed
  bool closed_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
};

}  // namespace slf
