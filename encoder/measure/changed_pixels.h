// SPDX-License-Identifier: Apache-2.0
// What moved between two photographs of one camera.
#pragma once

#include <cstdint>
#include <vector>

#include "slf/capture.h"

namespace slf {

/// Where a photograph differs from one of the same camera before it, beyond noise. [height][width]
/// The noise of both is estimated from what is left without local means; a pixel is changed where
/// the mean of 5 x 5 differences of a channel, or of their magnitudes, is beyond what noise makes.
/// O(pixels).
std::vector<std::uint8_t> changed_pixels(const Image& before, const Image& after);

}  // namespace slf
