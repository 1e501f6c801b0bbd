// SPDX-License-Identifier: Apache-2.0
// Rectangles side by side in a strip. Spec 8.11.4.
#pragma once

#include <cstdint>
#include <vector>

namespace slf {

struct Box {
  std::int32_t width = 0, height = 0;  ///< in steps, at least 1
  std::int32_t x = 0, y = 0;           ///< in steps; set by pack_boxes
};

/// Places boxes in the order given, each where its y is least, and then its x.
/// @param width  of the strip, in steps; no box is wider
/// @return the height used. O(boxes * width).
std::int32_t pack_boxes(std::vector<Box>& boxes, std::int32_t width);

}  // namespace slf
