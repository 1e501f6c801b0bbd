// SPDX-License-Identifier: Apache-2.0
// Which pixels of a photograph show the object, by the photograph alone.
#pragma once

#include <cstdint>
#include <vector>

#include "slf/capture.h"

namespace slf {

/// What is background where no alpha tells: all that is about as the border is, or what is hardly
/// told from it. The first leaves out parts of an object that are as grey as its background, the
/// second takes soft shadows along.
enum class Background { kLikely, kCertain };

/// [height][width] 1: the object. By alpha (a mask or the photograph's own), else by a background
/// that is even: what is like the border and reaches it. Empty: neither tells.
std::vector<std::uint8_t> object_outline(const Image& photograph,
                                         Background background = Background::kLikely);

}  // namespace slf
