// SPDX-License-Identifier: Apache-2.0
// Values for the pixels of a texture that no point has. Informative.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace slf {

/// Fills what is not occupied so that a transform codes it with few bits: means of what is
/// occupied, at the finest scale where there is any, interpolated (pull and push).
/// @param samples   [height][width]
/// @param occupied  [height][width]; at least one is
/// O(width * height). Integers alone: the same everywhere.
void pad_picture(std::vector<std::uint16_t>& samples, std::span<const std::uint8_t> occupied,
                 int width, int height);

}  // namespace slf
