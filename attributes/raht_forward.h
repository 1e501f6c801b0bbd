// Mirror of attributes/raht_inverse.h.
#pragma once

#include <cstdint>
#include <span>

#include "attributes/raht_tree.h"

namespace slf {

/// Values in, transform coefficients out, in place; see raht_inverse. |value| * sqrt(P) < 2^27.
void raht_forward(const RahtTree& tree, int planes, std::span<std::int32_t> values, int threads);

}  // namespace slf
