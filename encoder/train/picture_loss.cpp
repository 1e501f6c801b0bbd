// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/picture_loss.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/multiversion.h"
#include "slf/parallel.h"

namespace slf {
namespace {

// As encoder/measure/ssim.cpp has them, of values 0 .. 1.
constexpr int kRadius = 5;
constexpr double kSigma = 1.5;
constexpr float kC1 = 0.01f * 0.01f, kC2 = 0.03f * 0.03f;
constexpr Float3 kLuma = {0.299f, 0.587f, 0.114f};
constexpr float kSquareScale = 4;
constexpr std::size_t kRowsAtOnce = 16;

using Window = std::array<float, 2 * kRadius + 1>;

Window gaussian() {
  Window weights{};
  float sum = 0;
  for (int i = -kRadius; i <= kRadius; ++i)
    sum += weights[std::size_t(i + kRadius)] =
        float(std::exp(-double(i * i) / (2 * kSigma * kSigma)));
  for (float& w : weights) w /= sum;
  return weights;
}

SLF_MULTIVERSION_LANES void blur_row(const float* from, std::size_t width, const Window& window,
                                     float* to) {
  constexpr auto kReach = std::size_t(kRadius);
  for (std::size_t x = 0; x < width; ++x) to[x] = 0;
  for (std::size_t i = 0; i < window.size(); ++i) {
    const std::size_t first = i < kReach ? kReach - i : 0;
    const std::size_t last = std::min(width, width + kReach - i);
    for (std::size_t x = first; x < last; ++x) to[x] += window[i] * from[x + i - kReach];
  }
}

SLF_MULTIVERSION_LANES void add_row(const float* from, std::size_t width, float weight, float* to) {
  for (std::size_t x = 0; x < width; ++x) to[x] += weight * from[x];
}

/// The separable window, in place; nothing is outside of the picture.
void blur(std::vector<float>& image, std::vector<float>& rows, std::size_t width,
          std::size_t height, int threads) {
  static const Window kWindow = gaussian();
  parallel_ranges(height, kRowsAtOnce, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      blur_row(&image[y * width], width, kWindow, &rows[y * width]);
  });
  parallel_ranges(height, kRowsAtOnce, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      std::fill_n(&image[y * width], width, 0.0f);
      for (std::size_t i = 0; i < kWindow.size(); ++i) {
        const std::size_t row = y + i;
        if (row < std::size_t(kRadius) || row >= height + std::size_t(kRadius)) continue;
        add_row(&rows[(row - std::size_t(kRadius)) * width], width, kWindow[i], &image[y * width]);
      }
    }
  });
}

/// From moments of the window to what a change of each of the drawn picture's is worth, in place:
/// moments 0, 1, 2 are those of x, x^2, x y; 3, 4 of y, y^2. Returns the sum of similarities.
SLF_MULTIVERSION_LANES double similarity_gradient(std::array<float*, 5> m, std::size_t count) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const float mx = m[0][i], my = m[3][i];
    const float vx = m[1][i] - mx * mx, vy = m[4][i] - my * my, vxy = m[2][i] - mx * my;
    const float a1 = 2 * mx * my + kC1, a2 = 2 * vxy + kC2;
    const float b1 = mx * mx + my * my + kC1, b2 = vx + vy + kC2;
    const float inverse = 1 / (b1 * b2), similar = a1 * a2 * inverse;
    const float by_vxy = 2 * a1 * inverse, by_vx = -similar / b2;
    sum += double(similar);
    m[0][i] = 2 * my * a2 * inverse - 2 * mx * similar / b1 - my * by_vxy - 2 * mx * by_vx;
    m[1][i] = by_vx;
    m[2][i] = by_vxy;
  }
  return sum;
}

void set_moments(LossBuffers& b) {
  const std::size_t count = b.luma.size();
  b.moments.resize(5);
  for (auto& m : b.moments) m.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float x = b.luma[i], y = b.photograph[i];
    b.moments[0][i] = x, b.moments[1][i] = x * x, b.moments[2][i] = x * y;
    b.moments[3][i] = y, b.moments[4][i] = y * y;
  }
}

void set_luma(const PlanarPicture& picture, std::vector<float>& luma) {
  luma.assign(picture.pixels(), 0);
  for (std::size_t c = 0; c < 3; ++c) add_row(picture.plane(c), luma.size(), kLuma[c], luma.data());
}

/// Mean similarity; adds the gradient of -weight * sum of similarities.
double add_structure(const PlanarPicture& photograph, const PlanarPicture& drawn, float weight,
                     int threads, LossBuffers& b, PlanarPicture& gradient) {
  const auto width = std::size_t(drawn.width), height = std::size_t(drawn.height);
  const std::size_t count = width * height;
  set_luma(drawn, b.luma);
  set_luma(photograph, b.photograph);
  set_moments(b);
  b.rows.resize(count);
  for (auto& m : b.moments) blur(m, b.rows, width, height, threads);
  const std::size_t rows = (height + kRowsAtOnce - 1) / kRowsAtOnce;
  std::vector<double> sums(rows);
  parallel_ranges(rows, 1, threads, [&](std::size_t begin, std::size_t) {
    const std::size_t first = begin * kRowsAtOnce * width;
    const std::size_t last = std::min(first + kRowsAtOnce * width, count);
    sums[begin] =
        similarity_gradient({&b.moments[0][first], &b.moments[1][first], &b.moments[2][first],
                             &b.moments[3][first], &b.moments[4][first]},
                            last - first);
  });
  for (std::size_t k = 0; k < 3; ++k) blur(b.moments[k], b.rows, width, height, threads);
  for (std::size_t i = 0; i < count; ++i)
    b.rows[i] =
        b.moments[0][i] + 2 * b.luma[i] * b.moments[1][i] + b.photograph[i] * b.moments[2][i];
  for (std::size_t c = 0; c < 3; ++c)
    add_row(b.rows.data(), count, -weight * kLuma[c], gradient.plane(c));
  return std::accumulate(sums.begin(), sums.end(), 0.0) / double(count);
}

/// Sum of absolute |error| + squared error^2
SLF_MULTIVERSION_LANES double pixel_errors(const float* drawn, const float* photograph,
                                           std::size_t count, float absolute, float squared,
                                           float* gradient) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const float error = drawn[i] - photograph[i];
    sum += double(absolute * std::abs(error) + squared * error * error);
    gradient[i] = (error > 0 ? absolute : error < 0 ? -absolute : 0) + 2 * squared * error;
  }
  return sum;
}

/// The box with all that a window around one of its pixels, and one around a pixel of that, sees.
PictureBox seen_around(const PictureBox& box, const PlanarPicture& picture) {
  if (box.width == 0) return {0, 0, picture.width, picture.height};
  const int left = std::max(box.left - 2 * kRadius, 0), top = std::max(box.top - 2 * kRadius, 0);
  return {left, top, std::min(box.left + box.width + 2 * kRadius, picture.width) - left,
          std::min(box.top + box.height + 2 * kRadius, picture.height) - top};
}

/// @param whole, part  of the picture and of its box; the one that is const is copied from
template <class Whole, class Part, class Copy>
void for_each_row(Whole& whole, const PictureBox& box, Part& part, Copy&& copy) {
  for (std::size_t c = 0; c < 3; ++c)
    for (int y = 0; y < box.height; ++y)
      copy(whole.plane(c) + std::size_t(box.top + y) * std::size_t(whole.width) + box.left,
           part.plane(c) + std::size_t(y) * std::size_t(box.width));
}

void cut(const PlanarPicture& whole, const PictureBox& box, PlanarPicture& part) {
  part.width = box.width;
  part.height = box.height;
  part.value.resize(3 * part.pixels());
  for_each_row(whole, box, part,
               [&](const float* from, float* to) { std::copy_n(from, box.width, to); });
}

}  // namespace

void picture_loss(const TrainingView& view, const PlanarPicture& drawn, const LossShares& shares,
                  const PictureBox& looked_at, int threads, LossBuffers& b, PictureLoss& loss) {
  const PictureBox box = seen_around(looked_at, drawn);
  cut(view.picture, box, b.photograph_box);
  cut(drawn, box, b.drawn_box);
  PlanarPicture& gradient = b.gradient_box;
  gradient = {box.width, box.height, std::move(gradient.value)};
  gradient.value.resize(b.drawn_box.value.size());
  const float structure = shares.structure, pixels = (1 - structure) / 3;
  const double errors = pixel_errors(b.drawn_box.value.data(), b.photograph_box.value.data(),
                                     gradient.value.size(), pixels * (1 - shares.squared),
                                     pixels * shares.squared * kSquareScale, gradient.value.data());
  loss.value = 3 * errors / double(gradient.value.size());
  if (structure > 0) {
    const double similar =
        add_structure(b.photograph_box, b.drawn_box, structure, threads, b, gradient);
    loss.value += double(structure) * (1 - similar);
  }
  loss.gradient.width = drawn.width;
  loss.gradient.height = drawn.height;
  loss.gradient.value.assign(drawn.value.size(), 0);
  for_each_row(loss.gradient, box, gradient,
               [&](float* to, const float* from) { std::copy_n(from, box.width, to); });
}

}  // namespace slf
