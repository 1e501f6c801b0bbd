// SPDX-License-Identifier: Apache-2.0
// Some of the splats, in their order.
#pragma once

#include <algorithm>
#include <cstddef>

#include "slf/gaussians.h"

namespace slf {

/// @param is_kept  of a splat's index. O(splats).
template <class IsKept>
void keep_splats(Gaussians& splats, const IsKept& is_kept) {
  const std::size_t row = 3 * splats.num_harmonics();
  std::size_t kept = 0;
  for (std::size_t p = 0; p < splats.size(); ++p) {
    if (!is_kept(p)) continue;
    splats.positions[kept] = splats.positions[p];
    splats.log_deviations[kept] = splats.log_deviations[p];
    splats.rotations[kept] = splats.rotations[p];
    splats.logits[kept] = splats.logits[p];
    std::copy_n(&splats.harmonics[p * row], row, &splats.harmonics[kept * row]);
    ++kept;
  }
  splats.positions.resize(kept);
  splats.log_deviations.resize(kept);
  splats.rotations.resize(kept);
  splats.logits.resize(kept);
  splats.harmonics.resize(kept * row);
}

}  // namespace slf
