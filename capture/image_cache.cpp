// SPDX-License-Identifier: Apache-2.0
#include "capture/image_cache.h"

#include <algorithm>
#include <utility>

namespace slf {

std::shared_ptr<const Image> ImageCache::find(int camera) {
  const std::lock_guard lock(mutex_);
  const auto found = kept_.find(camera);
  if (found == kept_.end()) return nullptr;
  found->second.asked = ++time_;
  return found->second.image;
}

void ImageCache::keep(int camera, std::shared_ptr<const Image> image) {
  const std::uint64_t size = image->data.size();
  const std::lock_guard lock(mutex_);
  if (size > most_ || kept_.count(camera) != 0) return;
  while (bytes_ + size > most_) {
    const auto oldest = std::min_element(
        kept_.begin(), kept_.end(),
        [](const auto& a, const auto& b) { return a.second.asked < b.second.asked; });
    bytes_ -= oldest->second.image->data.size();
    kept_.erase(oldest);
  }
  bytes_ += size;
  kept_[camera] = {std::move(image), ++time_};
}

}  // namespace slf
