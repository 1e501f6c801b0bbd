// SPDX-License-Identifier: Apache-2.0
// Photographs as video codecs take them: BT.709 YCbCr, 8 bit, full range.
#pragma once

#include "attributes/video/picture.h"
#include "slf/capture.h"
#include "tools/rd/igc/igc.h"

namespace slf {

/// Format of the pictures: with 4:2:0 the size of the images, made even.
VideoFormat video_format(int width, int height, IgcChroma chroma, std::size_t pictures);

/// Alpha is left out. Edge pixels are repeated where the size was made even.
Picture to_ycbcr(const Image& image, IgcChroma chroma);

/// The image of width x height pixels again; the picture is of video_format().
Image to_rgb(const Picture& picture, int width, int height);

}  // namespace slf
