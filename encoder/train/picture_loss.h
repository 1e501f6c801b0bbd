// SPDX-License-Identifier: Apache-2.0
// How far a drawn picture is from its photograph, and which way is nearer.
#pragma once

#include <vector>

#include "encoder/train/draw_surfels.h"

namespace slf {

/// (1 - structure) * mean over channels of (1 - squared) |error| + squared 4 error^2
/// + structure * (1 - SSIM of the luma): Kerbl et al. (2023) with one channel in place of three,
/// and a share of squares, by which errors from 1/8 on weigh more. Highlights have these;
/// magnitudes alone make medians of them.
struct PictureLoss {
  double value = 0;        ///< mean over the picture's pixels
  PlanarPicture gradient;  ///< of the sum over pixels, by the drawn picture
};

/// Buffers that live longer than a call.
struct LossBuffers {
  std::vector<float> luma, photograph, rows;
  std::vector<std::vector<float>> moments;
};

/// Shares of the loss, each 0 .. 1.
struct LossShares {
  float structure = 0;  ///< 0 saves three quarters of the time
  float squared = 0;    ///< of what is not structure
};

/// The same for any number of threads. O(pixels).
void picture_loss(const TrainingView& view, const PlanarPicture& drawn, const LossShares& shares,
                  int threads, LossBuffers& buffers, PictureLoss& loss);

}  // namespace slf
