// SPDX-License-Identifier: Apache-2.0
// Mirror of attributes/raht_inverse.h.
#pragma once

#include <cstdint>
#include <span>

#include "attributes/raht_tree.h"

namespace slf {

/// Values in, transform coefficients out, in place; see raht_inverse. |value| * sqrt(P) < 2^27.
/// @param cells  of a slice, or 0: merges that join cells are not done, so that the first row of
///               each holds the sum of its values over sqrt(points)
void raht_forward(const RahtTree& tree, int planes, std::span<std::int32_t> values, int threads,
                  std::size_t cells = 0);

}  // namespace slf
