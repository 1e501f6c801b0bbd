// SPDX-License-Identifier: Apache-2.0
// Images beside each other.
#pragma once

#include <vector>

#include "slf/capture.h"

namespace slf::tools {

/// Three channels: alpha is composed onto `background`.
Image opaque(const Image& image, const std::array<std::uint8_t, 3>& background);

/// Tiles of one size, row by row, `columns` to a row; what is left of the last row is background.
/// @param images  at least one; three channels; all of the first one's size
Image mosaic(const std::vector<Image>& images, int columns,
             const std::array<std::uint8_t, 3>& background);

/// Columns that make `count` tiles about twice as wide as high: 8 -> 4.
int sheet_columns(int count);

}  // namespace slf::tools
