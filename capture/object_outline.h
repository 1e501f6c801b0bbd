// SPDX-License-Identifier: Apache-2.0
// Which pixels of a photograph show the object, by the photograph alone.
#pragma once

#include <cstdint>
#include <vector>

#include "slf/capture.h"

namespace slf {

/// Which pixels are background where no alpha tells. kLikely: within 14 grey levels of the border's
/// colour; parts of an object that are as grey are lost. kCertain: within what the border's own
/// noise explains; soft shadows belong to the object.
enum class Background { kLikely, kCertain };

/// [height][width] 1: the object. By alpha (a mask or the photograph's own), else by a background
/// that is even: what is like the border and reaches it. Empty: neither tells.
std::vector<std::uint8_t> object_outline(const Image& photograph,
                                         Background background = Background::kLikely);

}  // namespace slf
