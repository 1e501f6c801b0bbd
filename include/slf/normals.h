// SPDX-License-Identifier: Apache-2.0
// Coded normals as vectors.
#pragma once

#include <array>
#include <cstdint>

#include "slf/types.h"

namespace slf {

/// Unit vector of a coded normal. Spec 6.6.
/// @param coded  one entry of CodedNormals::octahedral; levels beyond the range count as the last
/// @param bits   CodedNormals::bits, 4 .. 12
Vec3 decode_normal(std::array<std::uint16_t, 2> coded, int bits);

}  // namespace slf
