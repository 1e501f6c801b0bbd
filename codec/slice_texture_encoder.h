// Coefficient units of a slice whose planes are pictures. Mirror of slice_texture_decoder.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slf/error.h"

namespace slf {

struct SliceInput;
struct SliceCoding;

/// What follows the unit headers, one a group. input.components become what a decoder gets,
/// where coding.digest asks for it.
/// @errors kInvalidArgument: values too large; an atlas larger than 8192. kUnsupported: x265, or
///         libde265 for the digest, is not part of this build.
Result<std::vector<std::vector<std::uint8_t>>, InputError> encode_slice_texture(
    const SliceInput& input, const SliceCoding& coding, int threads);

}  // namespace slf
