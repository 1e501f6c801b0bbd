#include "attributes/raht_inverse.h"

#include "attributes/raht_arithmetic.h"
#include "bitstream/multiversion.h"
#include "slf/parallel.h"

namespace slf {
namespace {

/// Planes tested for zeros together: 192 bytes of a row, three cache lines.
constexpr std::size_t kBlock = 48;

/// `lanes` of both rows of a merge. Most are zero in most merges.
inline void inverse_merge(const Merge& m, std::int32_t* __restrict low,
                          std::int32_t* __restrict high, std::size_t lanes) {
  std::int32_t any = 0;
  for (std::size_t j = 0; j < lanes; ++j) any |= low[j] | high[j];
  if (any == 0) return;
  for (std::size_t j = 0; j < lanes; ++j) {
    const std::int32_t mean = low[j], difference = high[j];
    low[j] = round_q30(std::int64_t{m.cos_q30} * mean - std::int64_t{m.sin_q30} * difference);
    high[j] = round_q30(std::int64_t{m.sin_q30} * mean + std::int64_t{m.cos_q30} * difference);
  }
}

SLF_MULTIVERSION
void inverse_lanes(std::span<const Merge> merges, std::int32_t* values, std::size_t stride,
                   std::size_t lanes) {
  for (const Merge& m : merges) {
    std::int32_t* low = values + m.left * stride;
    std::int32_t* high = values + m.right * stride;
    std::size_t j = 0;
    for (; j + kBlock <= lanes; j += kBlock) inverse_merge(m, low + j, high + j, kBlock);
    if (j < lanes) inverse_merge(m, low + j, high + j, lanes - j);
  }
}

}  // namespace

void raht_inverse(const RahtTree& tree, int planes, std::span<std::int32_t> values, int threads) {
  const auto stride = static_cast<std::size_t>(planes);
  // Whole rows on one thread: merges are depth first, so rows follow one another in memory.
  const auto parts =
      static_cast<std::size_t>(thread_count(threads, (stride + kBlock - 1) / kBlock));
  const std::size_t grain = ((stride + parts - 1) / parts + kBlock - 1) / kBlock * kBlock;
  parallel_ranges(stride, grain, threads, [&](std::size_t begin, std::size_t end) {
    inverse_lanes(tree.merges, values.data() + begin, stride, end - begin);
  });
}

std::int32_t node_mean(std::int32_t value, std::uint32_t weight) {
  const auto reciprocal_root = static_cast<std::int64_t>(isqrt((std::uint64_t{1} << 60) / weight));
  return round_q30(value * reciprocal_root);
}

}  // namespace slf
