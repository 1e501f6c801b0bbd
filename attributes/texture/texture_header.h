// SPDX-License-Identifier: Apache-2.0
// What stands before the pictures of a group. Spec 7.6.
#pragma once

#include <cstdint>
#include <vector>

#include "bitstream/syntax.h"

namespace slf {

/// value = tx_offset + sample * step; without a picture, tx_offset.
struct TexturePlane {
  std::uint32_t tx_picture_flag = 0;
  std::int32_t tx_offset = 0;
};

/// Every value of a texture is below this in magnitude.
inline constexpr std::int64_t kTextureLimit = std::int64_t{1} << 30;

// Spec 7.6  texture_header( )
template <class V, class Planes>
void texture_header(V& v, Planes& planes) {
  for (auto& plane : planes) {
    v.u(1, "tx_picture_flag", plane.tx_picture_flag, Range{0, 1});
    v.se("tx_offset", plane.tx_offset, Range{1 - kTextureLimit, kTextureLimit - 1});
  }
}

}  // namespace slf
