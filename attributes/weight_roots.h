// SPDX-License-Identifier: Apache-2.0
// Roots of the weights of nodes. Spec 8.7.6.
#pragma once

#include <array>
#include <cstdint>

namespace slf {

/// Roots of a weight w, 1 to 2^24 - 1.
struct WeightRoots {
  std::int32_t reciprocal_q30;  ///< 1 / sqrt(w)
  std::int32_t root_q19;        ///< sqrt(w)
};

WeightRoots compute_roots(std::uint32_t weight);

/// Those of most nodes, which have few points. [w]
using SmallRoots = std::array<WeightRoots, 512>;
const SmallRoots& small_roots();

inline WeightRoots roots_of(const SmallRoots& small, std::uint32_t weight) {
  return weight < small.size() ? small[weight] : compute_roots(weight);
}

}  // namespace slf
