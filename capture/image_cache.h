// SPDX-License-Identifier: Apache-2.0
// Photographs that were decoded, as many as fit.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

#include "slf/capture.h"

namespace slf {

/// The one that was not asked for the longest goes first. Thread-safe.
class ImageCache {
 public:
  explicit ImageCache(std::uint64_t bytes) : most_(bytes) {}

  /// Nothing if it is not kept.
  std::shared_ptr<const Image> find(int camera);
  /// One that does not fit by itself is not kept.
  void keep(int camera, std::shared_ptr<const Image> image);

 private:
  struct Kept {
    std::shared_ptr<const Image> image;
    std::uint64_t asked = 0;
  };

  std::mutex mutex_;
  std::map<int, Kept> kept_;
  std::uint64_t most_, bytes_ = 0, time_ = 0;
};

}  // namespace slf
