// SPDX-License-Identifier: Apache-2.0
#include "attributes/encoder/raht_forward.h"

#include "attributes/raht_arithmetic.h"
#include "base/multiversion.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kLanes = 48;

SLF_MULTIVERSION
void forward_lanes(const Merge* merges, std::size_t count, std::int32_t* values, std::size_t stride,
                   std::size_t lanes) {
  for (std::size_t i = count; i-- > 0;) {
    const Merge& m = merges[i];
    std::int32_t* __restrict left = values + m.left * stride;
    std::int32_t* __restrict right = values + m.right * stride;
    for (std::size_t j = 0; j < lanes; ++j) forward_merge(m, left[j], right[j]);
  }
}

}  // namespace

void raht_forward(const RahtTree& tree, int planes, std::span<std::int32_t> values, int threads,
                  std::size_t cells) {
  const auto merges = merges_below(tree, cells);
  const auto stride = static_cast<std::size_t>(planes);
  parallel_ranges(stride, kLanes, threads, [&](std::size_t begin, std::size_t end) {
    forward_lanes(merges.data(), merges.size(), values.data() + begin, stride, end - begin);
  });
}

}  // namespace slf
