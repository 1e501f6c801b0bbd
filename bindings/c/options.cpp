// SPDX-License-Identifier: Apache-2.0
#include "bindings/c/options.h"

#include <algorithm>

namespace slf::capi {

DecodeOptions options_of(const slf_options& given) {
  DecodeOptions options;
  const auto set = [](std::uint64_t value, std::uint64_t& limit) {
    if (value > 0) limit = value;
  };
  set(given.max_stream_bytes, options.limits.max_stream_bytes);
  set(given.max_points, options.limits.max_points);
  set(given.max_planes, options.limits.max_planes);
  set(given.max_memory_bytes, options.limits.max_memory);
  set(given.max_work, options.limits.max_work);
  options.levels = static_cast<int>(std::min(given.levels, 255u));
  options.groups = static_cast<int>(std::min(given.groups, 255u));
  options.layers = static_cast<int>(std::min(given.layers, 255u));
  options.max_bytes = given.max_bytes;
  options.threads = given.threads < 0 ? 0 : std::max(given.threads, 1);
  if (given.has_region) {
    VoxelBox box;
    std::copy_n(given.region_low, 3, box.low.begin());
    std::copy_n(given.region_high, 3, box.high.begin());
    options.region = box;
  }
  if (given.progress != nullptr)
    options.progress = [call = given.progress, user = given.user](double fraction) {
      return call(user, fraction) == 0;
    };
  return options;
}

bool is_usable(const slf_allocator* allocator) {
  return allocator == nullptr ||
         (allocator->allocate != nullptr) == (allocator->deallocate != nullptr);
}

}  // namespace slf::capi
