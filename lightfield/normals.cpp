// SPDX-License-Identifier: Apache-2.0
#include "slf/normals.h"

#include "lightfield/octahedral.h"

namespace slf {

Vec3 decode_normal(std::array<std::uint16_t, 2> coded, int bits) {
  return dequantise_normal(coded, bits);
}

}  // namespace slf
