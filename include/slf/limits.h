#pragma once

#include <cstdint>

namespace slf {

/// Textures (spec 8.11) take, beside what these bound, up to 17 pictures of fewer than 16 samples a
/// point for each thread.
///
/// A decoder refuses (kLimitExceeded) what is larger, before it allocates anything that large.
struct DecodeLimits {
  std::uint64_t max_stream_bytes = std::uint64_t{1} << 32;
  std::uint64_t max_points = std::uint64_t{1} << 26;
  std::uint64_t max_planes = 3 * 4096;
  std::uint64_t max_output_bytes = std::uint64_t{8} << 30;  ///< positions and components together
};

}  // namespace slf
