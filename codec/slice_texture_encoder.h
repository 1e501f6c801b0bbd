// Coefficient units of a slice whose planes are pictures. Mirror of slice_texture_decoder.cpp.
#pragma once

#include <span>
#include <vector>

#include "codec/slice_encoder.h"

namespace slf {

/// The payloads behind the unit headers, one a group. input.components become what a decoder gets,
/// where coding.digest asks for it.
/// @param local  Morton codes within the slice
/// @errors kInvalidArgument: values too large; an atlas larger than 8192. kUnsupported: x265, or
///         libde265 for the digest, is not part of this build.
Result<std::vector<std::vector<std::uint8_t>>, InputError> encode_slice_texture(
    const SliceCut& cut, const SliceInput& input, std::span<const std::uint64_t> local,
    const SliceCoding& coding, int threads);

}  // namespace slf
