// SPDX-License-Identifier: Apache-2.0
// Twin of codec/decoder/slice_texture_decoder.cpp for builds without textures (SLF_TEXTURE=OFF).
#include "codec/decoder/slice_decoder.h"

namespace slf {

Result<Done> decode_slice_texture(const SliceToDecode&, const SliceGeometry&,
                                  std::span<std::int32_t>, int) {
  return of_sequence(Errc::kUnsupported, "sps_coefficient_coder");
}

}  // namespace slf
