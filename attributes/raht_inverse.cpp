#include "attributes/raht_inverse.h"

#include "attributes/raht_arithmetic.h"
#include "bitstream/parallel.h"

namespace slf {
namespace {

/// Planes worked on together: a row part of 192 bytes, three cache lines.
constexpr std::size_t kLanes = 48;

SLF_MULTIVERSION
void inverse_lanes(const Merge* merges, std::size_t count, std::int32_t* values, std::size_t stride,
                   std::size_t lanes) {
  for (std::size_t i = 0; i < count; ++i) {
    const Merge& m = merges[i];
    std::int32_t* __restrict low = values + m.left * stride;
    std::int32_t* __restrict high = values + m.right * stride;
    const std::int64_t c = m.cos_q30, s = m.sin_q30;
    for (std::size_t j = 0; j < lanes; ++j) {
      const std::int64_t mean = low[j], difference = high[j];
      low[j] = round_q30(c * mean - s * difference);
      high[j] = round_q30(s * mean + c * difference);
    }
  }
}

}  // namespace

void raht_inverse(const RahtTree& tree, int planes, std::span<std::int32_t> values, int threads) {
  const auto stride = static_cast<std::size_t>(planes);
  parallel_ranges(stride, kLanes, threads, [&](std::size_t begin, std::size_t end) {
    inverse_lanes(tree.merges.data(), tree.merges.size(), values.data() + begin, stride, end - begin);
  });
}

std::int32_t node_mean(std::int32_t value, std::uint32_t weight) {
  const auto reciprocal_root = static_cast<std::int64_t>(isqrt((std::uint64_t{1} << 60) / weight));
  return round_q30(value * reciprocal_root);
}

}  // namespace slf
