// Structural similarity of two images inside a mask.
#pragma once

#include <cstdint>
#include <span>

namespace slf {

struct SsimSum {
  double sum = 0;           ///< of the similarity of every pixel in the mask, each -1 .. 1
  std::uint64_t count = 0;  ///< pixels in the mask
};

/// Similarity in a Gaussian window of 11 x 11, sigma 1.5, K1 = 0.01, K2 = 0.03, peak 255. Windows
/// see only pixels in the mask, their weights scaled to a sum of 1, so that neither background nor
/// holes count.
/// @param a, b  [height][width] luma, 0 .. 255
/// @param mask  [height][width] not 0: compared
/// O(width * height). Source: Wang, Bovik, Sheikh, Simoncelli, IEEE TIP 13(4), 2004.
SsimSum ssim(std::span<const float> a, std::span<const float> b, std::span<const std::uint8_t> mask,
             int width, int height);

}  // namespace slf
