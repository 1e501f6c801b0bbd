// SPDX-License-Identifier: Apache-2.0
// Structural similarity of two images inside a mask, at one scale and at five.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace slf {

struct SsimSum {
  double sum = 0;            ///< of the similarity of every pixel in the mask, each -1 .. 1
  double structure_sum = 0;  ///< the same of contrast and structure alone, without luminance
  std::uint64_t count = 0;   ///< pixels in the mask
};

/// Similarity in a Gaussian window of 11 x 11, sigma 1.5, K1 = 0.01, K2 = 0.03, peak 255. Windows
/// see only pixels in the mask, their weights scaled to a sum of 1, so that neither background nor
/// holes count.
/// @param a, b  [height][width] luma, 0 .. 255
/// @param mask  [height][width] not 0: compared
/// O(width * height). Source: Wang, Bovik, Sheikh, Simoncelli, IEEE TIP 13(4), 2004.
SsimSum ssim(std::span<const float> a, std::span<const float> b, std::span<const std::uint8_t> mask,
             int width, int height);

/// MS-SSIM: the means of contrast and structure at five scales, each half the one before, and of
/// the whole similarity at the last, to the powers 0.0448, 0.2856, 0.3001, 0.2363, 0.1333,
/// multiplied. A mean below 0 counts as 0. A pixel of a coarser scale is the mean of those of its 2
/// x 2 that are in the mask, and in the mask where one is. Where a side would fall below 11 pixels,
/// the window, the scale before is the last, and the powers of those that are left are scaled to a
/// sum of 1; an image smaller than that has one scale.
/// @return 0 .. 1; nothing where the mask is empty
/// Source: Wang, Simoncelli, Bovik, "Multi-scale structural similarity for image quality
/// assessment", Asilomar 2003.
std::optional<double> ms_ssim(std::span<const float> a, std::span<const float> b,
                              std::span<const std::uint8_t> mask, int width, int height);

}  // namespace slf
