// SPDX-License-Identifier: Apache-2.0
// Which pixels of a photograph show the object: what every room asks of masks and alpha.
#pragma once

#include <cstdint>

#include "slf/capture.h"

namespace slf {

/// Whether a pixel of this alpha shows the object. One limit for fit, training and measures, so
/// that a pixel that is fitted is a pixel that is judged.
inline constexpr bool shows_object(std::uint8_t alpha) { return alpha >= 128; }

/// Makes every sample of a mask 0 or 255: 128 and more is the object. Where no sample is 128 or
/// more (0 and 1, as segmentation writes them, or labels), all that is not 0 is.
void flatten_mask(Image& mask);

/// Without its alpha where that says nothing: it is 255 everywhere, as many programs write it.
Image without_opaque_alpha(Image image);

}  // namespace slf
