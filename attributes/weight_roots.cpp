// SPDX-License-Identifier: Apache-2.0
#include "attributes/weight_roots.h"

#include "geometry/isqrt.h"

namespace slf {

WeightRoots compute_roots(std::uint32_t weight) {
  return {static_cast<std::int32_t>(isqrt((std::uint64_t{1} << 60) / weight)),
          static_cast<std::int32_t>(isqrt(std::uint64_t{weight} << 38))};
}

const SmallRoots& small_roots() {
  static const SmallRoots table = [] {
    SmallRoots roots{};
    for (std::uint32_t w = 1; w < roots.size(); ++w) roots[w] = compute_roots(w);
    return roots;
  }();
  return table;
}

}  // namespace slf
