// SPDX-License-Identifier: Apache-2.0
// How far a drawn picture is from its photograph, and which way is nearer.
#pragma once

#include "encoder/train/structure_loss.h"

namespace slf {

/// (1 - structure) * mean over channels of (1 - squared) |error| + squared 4 error^2
/// + structure * (1 - SSIM of the luma): Kerbl et al. (2023) with one channel in place of three,
/// and a share of squares, by which errors from 1/8 on weigh more. Highlights have these;
/// magnitudes alone make medians of them.
struct PictureLoss {
  double value = 0;        ///< mean over the pixels that are looked at
  PlanarPicture gradient;  ///< of the sum over pixels, by the drawn picture; 0 outside of the box
  PictureBox box;          ///< with what windows see around it
};

/// Shares of the loss, each 0 .. 1.
struct LossShares {
  float structure = 0;  ///< 0 saves three quarters of the time
  float squared = 0;    ///< of what is not structure
};

/// @param box  within the picture. Its gradient is that of a loss of all pixels, to rounding; the
///             window of SSIM needs what is around it.
/// The same for any number of threads. O(pixels of the box).
void picture_loss(const TrainingView& view, const PlanarPicture& drawn, const LossShares& shares,
                  const PictureBox& box, int threads, SimilarityBuffers& buffers,
                  PictureLoss& loss);

}  // namespace slf
