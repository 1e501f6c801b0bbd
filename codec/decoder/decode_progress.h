// SPDX-License-Identifier: Apache-2.0
// How far a decode has come, and whether it shall go on.
#pragma once

#include <cstdint>
#include <functional>

#include "base/monitor.h"
#include "slf/error.h"

namespace slf {

/// Told of units by the threads that decode them; tells the caller, one thread at a time.
class DecodeProgress {
 public:
  /// @param bytes  of all units that will be decoded
  DecodeProgress(std::function<bool(double)> progress, std::uint64_t bytes)
      : progress_(std::move(progress)), all_(bytes) {}

  /// A unit of so many bytes is about to be decoded.
  /// @errors kCancelled, also ever after.
  Result<Done> begin_unit(std::uint64_t bytes) {
    bool stopped = false;
    monitor_.change([&] {
      const double share = all_ == 0 ? 0 : static_cast<double>(done_) / static_cast<double>(all_);
      stopped_ = stopped_ || !progress_(share < 1 ? share : 1);
      done_ += bytes;
      stopped = stopped_;
    });
    if (stopped) return Error{Errc::kCancelled, "progress"};
    return Done{};
  }

 private:
  std::function<bool(double)> progress_;
  std::uint64_t all_, done_ = 0;
  bool stopped_ = false;
  Monitor monitor_;
};

}  // namespace slf
