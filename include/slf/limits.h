// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace slf {

/// A stream beyond these limits is refused (kLimitExceeded) by its headers, before memory for it is
/// allocated. The defaults fit a laptop. Spec 9.
struct DecodeLimits {
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};

  std::uint64_t max_stream_bytes = std::uint64_t{1} << 32;
  std::uint64_t max_points = std::uint64_t{1} << 26;
  std::uint64_t max_planes = 3 * 4096;
  /// Bytes that a decode may need at a time, all counted: the light field, trees, coder states,
  /// slices in flight on all threads. DecodeCost::memory_most is held against it.
  std::uint64_t max_memory = std::uint64_t{1} << 30;
  /// Steps: decisions of octree nodes (8 each) and values of components, whatever the bytes say,
  /// and 64 bytes of each state that one of several slices starts from.
  /// DecodeCost::work is held against it; a core takes some 10^8 of them a second.
  std::uint64_t max_work = std::uint64_t{1} << 35;

  /// Values of components, beyond the first kFreeValues, for every byte of the stream: a few bytes
  /// can say that millions of values are 0. Files of `slf encode` have some hundreds.
  std::uint64_t max_values_per_byte = std::uint64_t{1} << 14;
  static constexpr std::uint64_t kFreeValues = std::uint64_t{1} << 22;

  /// For streams that the caller has just made.
  static DecodeLimits none() { return {kNone, kNone, kNone, kNone, kNone, kNone}; }
};

}  // namespace slf
