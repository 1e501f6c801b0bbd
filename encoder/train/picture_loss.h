// SPDX-License-Identifier: Apache-2.0
// How far a drawn picture is from its photograph, and which way is nearer.
#pragma once

#include <vector>

#include "encoder/train/draw_surfels.h"

namespace slf {

/// (1 - structure) * mean |error| over channels + structure * (1 - SSIM of the luma), Kerbl et al.
/// (2023) with one channel in place of three.
struct PictureLoss {
  double value = 0;        ///< mean over the picture's pixels
  PlanarPicture gradient;  ///< of the sum over pixels, by the drawn picture
};

/// Buffers that live longer than a call.
struct LossBuffers {
  std::vector<float> luma, photograph, rows;
  std::vector<std::vector<float>> moments;
};

/// @param structure  0 .. 1; 0 saves three quarters of the time
/// The same for any number of threads. O(pixels).
void picture_loss(const TrainingView& view, const PlanarPicture& drawn, float structure,
                  int threads, LossBuffers& buffers, PictureLoss& loss);

}  // namespace slf
