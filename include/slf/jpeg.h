// SPDX-License-Identifier: Apache-2.0
// JPEG, for previews: pictures that are looked at, not measured.
#pragma once

#include <cstdint>
#include <vector>

#include "slf/capture.h"

namespace slf {

/// Baseline JPEG with 4:2:0 chroma.
/// @param image    RGB, 1 .. 16384 pixels a side
/// @param quality  1 .. 100, as libjpeg has it
/// @errors kInvalidArgument: another number of channels, another size than its data. kUnwritable:
///         libjpeg's own, as text. Thread-safe.
Result<std::vector<std::uint8_t>, InputError> encode_jpeg(const Image& image, int quality);

}  // namespace slf
