// SPDX-License-Identifier: Apache-2.0
// The picture that a page shows until its file is decoded, where one was given.
#pragma once

#include <string>

#include "tools/failure.h"

namespace slf::tools {

inline constexpr int kPosterQuality = 75;  ///< of a JPEG

/// As an address with the picture in it: as it is, or as JPEG where browsers do not know its
/// format.
/// @errors those of read_image; kLimitExceeded: more than 4096 pixels a side, or 8 MiB
Result<std::string, Failure> given_poster(const std::string& file);

}  // namespace slf::tools
