// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/picture_loss.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/multiversion.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr float kSquareScale = 4;
constexpr std::size_t kSums = 16;  // side by side, so that a compiler adds them at once

/// Sum of absolute |error| + squared error^2
SLF_MULTIVERSION_LANES float pixel_errors(const float* drawn, const float* photograph,
                                          std::size_t count, float absolute, float squared,
                                          float* gradient) {
  std::array<float, kSums> sums{};
  const auto add = [&](std::size_t i, float& sum) {
    const float error = drawn[i] - photograph[i];
    const float magnitude = error < 0 ? -error : error;
    sum += absolute * magnitude + squared * error * error;
    gradient[i] = (error > 0 ? absolute : error < 0 ? -absolute : 0) + 2 * squared * error;
  };
  std::size_t i = 0;
  for (; i + kSums <= count; i += kSums)
    for (std::size_t k = 0; k < kSums; ++k) add(i + k, sums[k]);
  for (; i < count; ++i) add(i, sums[0]);
  return std::accumulate(sums.begin(), sums.end(), 0.0f);
}

/// The box with all that a window around one of its pixels, and one around a pixel of that, sees.
PictureBox seen_around(const PictureBox& box, const PlanarPicture& picture) {
  constexpr int kWindows = 2 * kSimilarityRadius;
  if (box.width == 0) return {0, 0, picture.width, picture.height};
  const int left = std::max(box.left - kWindows, 0), top = std::max(box.top - kWindows, 0);
  return {left, top, std::min(box.left + box.width + kWindows, picture.width) - left,
          std::min(box.top + box.height + kWindows, picture.height) - top};
}

/// Makes the gradient one of the picture's size, 0 everywhere.
void clear(const PlanarPicture& picture, const PictureBox& written, PlanarPicture& gradient) {
  if (gradient.width != picture.width || gradient.height != picture.height) {
    gradient.width = picture.width;
    gradient.height = picture.height;
    gradient.value.assign(picture.value.size(), 0);
    return;
  }
  for (std::size_t c = 0; c < 3; ++c)
    for (int y = written.top; y < written.top + written.height; ++y)
      std::fill_n(gradient.plane(c) + std::size_t(y) * std::size_t(picture.width) + written.left,
                  written.width, 0.0f);
}

/// @return sum over pixels and channels
double add_errors(const PlanarPicture& photograph, const PlanarPicture& drawn,
                  const PictureBox& box, float absolute, float squared, int threads,
                  PlanarPicture& gradient) {
  const auto height = std::size_t(box.height);
  std::vector<double> sums((height + kLossRows - 1) / kLossRows);
  parallel_ranges(height, kLossRows, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t first =
            (std::size_t(box.top) + y) * std::size_t(drawn.width) + std::size_t(box.left);
        sums[begin / kLossRows] += double(
            pixel_errors(drawn.plane(c) + first, photograph.plane(c) + first,
                         std::size_t(box.width), absolute, squared, gradient.plane(c) + first));
      }
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace

void picture_loss(const TrainingView& view, const PlanarPicture& drawn, const LossShares& shares,
                  const PictureBox& looked_at, int threads, SimilarityBuffers& buffers,
                  PictureLoss& loss) {
  const PictureBox box = seen_around(looked_at, drawn);
  clear(drawn, loss.box, loss.gradient);
  loss.box = box;
  const float structure = shares.structure, pixels = (1 - structure) / 3;
  const double errors = add_errors(view.picture, drawn, box, pixels * (1 - shares.squared),
                                   pixels * shares.squared * kSquareScale, threads, loss.gradient);
  loss.value = errors / (double(box.width) * double(box.height));
  if (!(structure > 0)) return;
  const double similar =
      add_similarity_gradient(view.picture, drawn, box, structure, threads, buffers, loss.gradient);
  loss.value += double(structure) * (1 - similar);
}

}  // namespace slf
