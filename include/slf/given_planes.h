// SPDX-License-Identifier: Apache-2.0
// From the coded functions back to the planes that were given to an encoder. Spec 8.7.5.
#pragma once

#include <cstdint>
#include <vector>

#include "slf/types.h"

namespace slf {

/// [P][K][3] integers of all functions of the header: the components themselves where there is no
/// transform, zero where groups were left out. A renderer needs none of them (slf/view_map.h).
/// Exact on every platform. O(P K R).
std::vector<std::int32_t> given_planes(const LightField& light_field, int threads = 0);

}  // namespace slf
