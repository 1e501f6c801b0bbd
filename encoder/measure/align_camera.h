// SPDX-License-Identifier: Apache-2.0
// A camera that stands where its photograph says, within what a picture tells.
#pragma once

#include "slf/capture.h"
#include "slf/render.h"

namespace slf {

/// What a camera's picture was moved by.
struct Alignment {
  Camera camera;
  double pixels = 0;  ///< root mean square over the drawn pixels
};

/// The camera with its picture shifted, turned and scaled as brings the drawn pixels nearest to the
/// photograph: least squares of luma along its gradients, large differences weighed down (Lucas and
/// Kanade 1981, Huber weights). The camera as it was where too little is drawn, or where a picture
/// would have to move by more than 4 pixels: that is no error of a pose.
/// @param drawn  from that camera, over the same background as the photograph
Alignment aligned(const Camera& camera, const Image& photograph, const Image& drawn,
                  const std::vector<std::uint8_t>& coverage);

}  // namespace slf
