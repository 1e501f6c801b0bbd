// SPDX-License-Identifier: Apache-2.0
#include "attributes/texture/box_packing.h"

#include <algorithm>
#include <cstddef>
#include <deque>
#include <limits>

namespace slf {
namespace {

/// Sets x and y of the box: a maximum over a window that slides along the skyline.
void place(Box& box, const std::vector<std::int32_t>& skyline) {
  const auto width = static_cast<std::size_t>(box.width);
  box.y = std::numeric_limits<std::int32_t>::max();
  std::deque<std::size_t> highest;  // columns of the window, those that a later one hides left out
  for (std::size_t right = 0; right < skyline.size(); ++right) {
    while (!highest.empty() && skyline[highest.back()] <= skyline[right]) highest.pop_back();
    highest.push_back(right);
    if (highest.front() + width <= right) highest.pop_front();
    if (right + 1 < width || skyline[highest.front()] >= box.y) continue;
    box.y = skyline[highest.front()];
    box.x = static_cast<std::int32_t>(right + 1 - width);
  }
}

}  // namespace

std::int32_t pack_boxes(std::vector<Box>& boxes, std::int32_t width) {
  std::vector<std::int32_t> skyline(static_cast<std::size_t>(width), 0);
  for (Box& box : boxes) {
    place(box, skyline);
    std::fill_n(skyline.begin() + box.x, box.width, box.y + box.height);
  }
  return *std::max_element(skyline.begin(), skyline.end());
}

}  // namespace slf
