// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/structure_loss.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/multiversion.h"
#include "slf/parallel.h"

namespace slf {
namespace {

// As encoder/measure/ssim.cpp has them, of values 0 .. 1.
constexpr auto kReach = std::size_t(kSimilarityRadius);
constexpr double kSigma = 1.5;
constexpr float kC1 = 0.01f * 0.01f, kC2 = 0.03f * 0.03f;
constexpr Float3 kLuma = {0.299f, 0.587f, 0.114f};

using Window = std::array<float, 2 * kReach + 1>;

Window gaussian_window() {
  Window weights{};
  float sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double x = double(i) - double(kReach);
    sum += weights[i] = float(std::exp(-x * x / (2 * kSigma * kSigma)));
  }
  for (float& w : weights) w /= sum;
  return weights;
}

/// @param from  the first of what the window covers at the first pixel
/// @param apart  between what it covers: 1, or a row
[[gnu::always_inline]] inline void blur(const float* __restrict from, std::size_t apart,
                                        std::size_t width, const Window& window,
                                        float* __restrict to) {
  for (std::size_t x = 0; x < width; ++x) {
    float sum = 0;
#pragma GCC unroll 11
    for (std::size_t i = 0; i < 2 * kReach + 1; ++i) sum += window[i] * from[x + i * apart];
    to[x] = sum;
  }
}

SLF_MULTIVERSION_LANES void blur_row(const float* from, std::size_t width, const Window& window,
                                     float* to) {
  blur(from, 1, width, window, to);
}

SLF_MULTIVERSION_LANES void blur_column(const float* from, std::size_t width, const Window& window,
                                        float* to) {
  blur(from, width, width, window, to);
}

/// From moments of the window to what a change of each of the drawn picture's is worth: 0, 1, 2 are
/// those of x, x^2, x y, which it takes the place of; 3, 4 of y, y^2.
SLF_MULTIVERSION_LANES void similarity_gradient(std::array<float*, 5> m, std::size_t count,
                                                float* similarity) {
  for (std::size_t i = 0; i < count; ++i) {
    const float mx = m[0][i], my = m[3][i];
    const float vx = m[1][i] - mx * mx, vy = m[4][i] - my * my, vxy = m[2][i] - mx * my;
    const float a1 = 2 * mx * my + kC1, a2 = 2 * vxy + kC2;
    const float b1 = mx * mx + my * my + kC1, b2 = vx + vy + kC2;
    const float inverse = 1 / (b1 * b2), similar = a1 * a2 * inverse;
    const float by_vxy = 2 * a1 * inverse, by_vx = -similar * b1 * inverse;
    m[0][i] = 2 * my * (a2 * inverse - by_vxy / 2) - 2 * mx * (similar * b2 * inverse + by_vx);
    m[1][i] = by_vx;
    m[2][i] = by_vxy;
    similarity[i] = similar;
  }
}

SLF_MULTIVERSION_LANES void set_luma(std::array<const float*, 3> from, std::size_t width,
                                     float* luma) {
  for (std::size_t x = 0; x < width; ++x)
    luma[x] = kLuma[0] * from[0][x] + kLuma[1] * from[1][x] + kLuma[2] * from[2][x];
}

SLF_MULTIVERSION_LANES void multiply(const float* a, const float* b, std::size_t width,
                                     float* product) {
  for (std::size_t x = 0; x < width; ++x) product[x] = a[x] * b[x];
}

SLF_MULTIVERSION_LANES void add_luma_gradient(std::array<const float*, 3> by, const float* drawn,
                                              const float* photograph, float weight,
                                              std::size_t width, std::array<float*, 3> gradient) {
  for (std::size_t x = 0; x < width; ++x) {
    const float luma = weight * (by[0][x] + 2 * drawn[x] * by[1][x] + photograph[x] * by[2][x]);
    for (std::size_t c = 0; c < 3; ++c) gradient[c][x] += kLuma[c] * luma;
  }
}

/// A row of the box, of each channel.
template <class Picture>
auto row_of(Picture& picture, const PictureBox& box, std::size_t y) {
  const std::size_t first =
      (std::size_t(box.top) + y) * std::size_t(picture.width) + std::size_t(box.left);
  return std::array{picture.plane(0) + first, picture.plane(1) + first, picture.plane(2) + first};
}

/// The comparison of a box of two pictures, a few rows at a time.
class Comparison {
 public:
  Comparison(const PlanarPicture& photograph, const PlanarPicture& drawn, const PictureBox& box,
             SimilarityBuffers& buffers)
      : photograph_(photograph),
        drawn_(drawn),
        box_(box),
        width_(std::size_t(box.width)),
        height_(std::size_t(box.height)),
        b_(buffers) {
    b_.drawn.resize(width_ * height_);
    b_.photograph.resize(width_ * height_);
    for (auto& plane : b_.moments) add_border(plane);
    for (auto& plane : b_.gradients) add_border(plane);
  }

  /// Lumas, and moments along rows.
  void start_rows(std::size_t begin, std::size_t end) {
    std::array<std::vector<float>, 5> m;  // a row, with what a window sees beside it
    for (auto& row : m) row.assign(width_ + 2 * kReach, 0);
    for (std::size_t y = begin; y < end; ++y) {
      set_luma(row_of(drawn_, box_, y), width_, &m[0][kReach]);
      set_luma(row_of(photograph_, box_, y), width_, &m[3][kReach]);
      std::copy_n(&m[0][kReach], width_, &b_.drawn[y * width_]);
      std::copy_n(&m[3][kReach], width_, &b_.photograph[y * width_]);
      multiply(m[0].data(), m[0].data(), m[0].size(), m[1].data());
      multiply(m[0].data(), m[3].data(), m[0].size(), m[2].data());
      multiply(m[3].data(), m[3].data(), m[0].size(), m[4].data());
      for (std::size_t k = 0; k < 5; ++k)
        blur_row(m[k].data(), width_, window_, &b_.moments[k][(y + kReach) * width_]);
    }
  }

  /// Similarities and gradients by moments, these along rows.
  /// @return sum of similarities
  double compare_rows(std::size_t begin, std::size_t end) {
    std::array<std::vector<float>, 5> m;
    for (auto& row : m) row.assign(width_ + 2 * kReach, 0);
    std::vector<float> similarity(width_);
    double sum = 0;
    for (std::size_t y = begin; y < end; ++y) {
      for (std::size_t k = 0; k < 5; ++k)
        blur_column(&b_.moments[k][y * width_], width_, window_, &m[k][kReach]);
      similarity_gradient(
          {&m[0][kReach], &m[1][kReach], &m[2][kReach], &m[3][kReach], &m[4][kReach]}, width_,
          similarity.data());
      for (std::size_t k = 0; k < 3; ++k)
        blur_row(m[k].data(), width_, window_, &b_.gradients[k][(y + kReach) * width_]);
      sum += double(std::accumulate(similarity.begin(), similarity.end(), 0.0f));
    }
    return sum;
  }

  void finish_rows(std::size_t begin, std::size_t end, float weight, PlanarPicture& gradient) {
    std::array<std::vector<float>, 3> by;
    for (auto& row : by) row.resize(width_);
    for (std::size_t y = begin; y < end; ++y) {
      for (std::size_t k = 0; k < 3; ++k)
        blur_column(&b_.gradients[k][y * width_], width_, window_, by[k].data());
      add_luma_gradient({by[0].data(), by[1].data(), by[2].data()}, &b_.drawn[y * width_],
                        &b_.photograph[y * width_], weight, width_, row_of(gradient, box_, y));
    }
  }

 private:
  void add_border(std::vector<float>& plane) const {
    plane.resize(width_ * (height_ + 2 * kReach));
    std::fill_n(plane.begin(), kReach * width_, 0.0f);
    std::fill_n(plane.end() - std::ptrdiff_t(kReach * width_), kReach * width_, 0.0f);
  }

  const PlanarPicture &photograph_, &drawn_;
  const PictureBox& box_;
  std::size_t width_, height_;
  SimilarityBuffers& b_;
  const Window window_ = gaussian_window();
};

}  // namespace

double add_similarity_gradient(const PlanarPicture& photograph, const PlanarPicture& drawn,
                               const PictureBox& box, float weight, int threads,
                               SimilarityBuffers& buffers, PlanarPicture& gradient) {
  Comparison comparison(photograph, drawn, box, buffers);
  const auto height = std::size_t(box.height);
  parallel_ranges(height, kLossRows, threads,
                  [&](std::size_t begin, std::size_t end) { comparison.start_rows(begin, end); });
  std::vector<double> sums((height + kLossRows - 1) / kLossRows);
  parallel_ranges(height, kLossRows, threads, [&](std::size_t begin, std::size_t end) {
    sums[begin / kLossRows] = comparison.compare_rows(begin, end);
  });
  parallel_ranges(height, kLossRows, threads, [&](std::size_t begin, std::size_t end) {
    comparison.finish_rows(begin, end, -weight, gradient);
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0) / (double(box.width) * double(box.height));
}

}  // namespace slf
