// SPDX-License-Identifier: Apache-2.0
// PPM and PGM: pictures of the Netpbm programs, P2, P3, P5 and P6.
#pragma once

#include <string>

#include "capture/image_formats.h"

namespace slf {

bool is_netpbm(Bytes file);

/// From the first bytes of a file; nothing if they do not say.
std::optional<ImageSize> netpbm_size(Bytes start);

/// To 8 bits, grey to RGB. What follows the picture is not read.
/// @param name  for messages
/// @errors kInvalidInput: damaged, cut off, too large
Result<Image, InputError> decode_netpbm(const std::string& name, Bytes file);

}  // namespace slf
