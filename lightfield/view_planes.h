// SPDX-License-Identifier: Apache-2.0
// The functions of direction of a light field alone, where its components are not their weights.
#pragma once

#include <cstdint>
#include <vector>

#include "slf/types.h"

namespace slf {

/// With a joint transform (6.7), or attributes (6.8).
bool needs_view_planes(const LightFieldHeader& header);

/// The header that goes with view_planes(): no attributes, and no transform but of none.
LightFieldHeader view_header(LightFieldHeader header);

/// [P][K'][3] given planes of the K' functions of direction. O(P K R).
std::vector<std::int32_t> view_planes(const LightField& field, int threads);

}  // namespace slf
