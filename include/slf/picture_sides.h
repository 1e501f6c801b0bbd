// SPDX-License-Identifier: Apache-2.0
// How large a picture is, before it is decoded.
#pragma once

#include <cstdint>
#include <filesystem>

#include "slf/error.h"

namespace slf {

struct PictureSides {
  std::uint32_t width = 0, height = 0;  ///< pixels, as the header has them
};

/// PNG, JPEG, PPM or PGM, by content. Reads some kilobytes.
/// @errors kUnreadable; kInvalidInput: something else, or without a header
Result<PictureSides, InputError> picture_sides(const std::filesystem::path& file);

}  // namespace slf
