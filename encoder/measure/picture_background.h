// SPDX-License-Identifier: Apache-2.0
// Photograph and rendering over one background: what stands behind the object. Spec annex D.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "slf/capture.h"
#include "slf/render.h"

namespace slf {

/// What pixels show that the object does not fill. A photograph with an alpha channel of its own
/// has nothing there: grey 128. Else (a mask, or neither) the median, per channel, of those pixels
/// at the photograph's border that do not show the object; where all of them do, of all of them.
/// @param object  [height][width] not 0: shows the object
std::array<std::uint8_t, 3> picture_background(const Image& photograph,
                                               const std::vector<std::uint8_t>& object,
                                               bool alpha_is_mask);

/// The photograph as RGB: alpha blends it with the background.
Image over_background(const Image& photograph, const std::array<std::uint8_t, 3>& background);

/// The same of a rendering over black (RenderSettings::background). Within one grey level of a
/// rendering over that background, exact where a pixel is wholly covered or not at all.
Image over_background(const Rendering& over_black, const std::array<std::uint8_t, 3>& background);

}  // namespace slf
