// SPDX-License-Identifier: Apache-2.0
// Photographs that are stored on their side.
#pragma once

#include "slf/capture.h"

namespace slf {

/// The picture as its EXIF orientation shows it. @param orientation  1 .. 8; 1: as it is stored
Image upright(Image image, int orientation);

}  // namespace slf
