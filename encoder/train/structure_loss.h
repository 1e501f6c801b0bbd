// SPDX-License-Identifier: Apache-2.0
// Structural similarity of two pictures' lumas, and which way it grows.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "encoder/train/training_view.h"

namespace slf {

/// Pixels of a picture that are looked at: left, top, width, height. Empty: all of them.
struct PictureBox {
  int left = 0, top = 0, width = 0, height = 0;
};

inline constexpr int kSimilarityRadius = 5;   ///< pixels: of the window
inline constexpr std::size_t kLossRows = 16;  ///< of a picture, that are compared at once

/// Buffers that live longer than a call. Planes have kSimilarityRadius rows of 0 above and below.
struct SimilarityBuffers {
  std::vector<float> drawn, photograph;         ///< lumas
  std::array<std::vector<float>, 5> moments;    ///< of the window, along rows
  std::array<std::vector<float>, 3> gradients;  ///< by moments, blurred along rows
};

/// Adds the gradient of -weight * the sum of similarities over the box's pixels by the drawn
/// picture. Windows end at the box.
/// @return mean similarity over the box
/// The same for any number of threads. O(pixels of the box).
double add_similarity_gradient(const PlanarPicture& photograph, const PlanarPicture& drawn,
                               const PictureBox& box, float weight, int threads,
                               SimilarityBuffers& buffers, PlanarPicture& gradient);

}  // namespace slf
